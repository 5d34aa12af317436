#pragma once

#include <cstddef>
#include <vector>

namespace shaken {

/// Heap memory held by vectors, whether in use or in reserve [bytes].
template <class... T>
std::size_t heap_bytes(const std::vector<T>&... vectors) {
  return ((vectors.capacity() * sizeof(T)) + ... + 0);
}

}  // namespace shaken
