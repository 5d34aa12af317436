#include "base/memory_reserve.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace shaken {
namespace {

constexpr std::size_t kBytes = std::size_t{4} << 20;
std::atomic<void*> reserve{nullptr};

/// What operator new calls before it tries once more.
void give_it_up() {
  void* kept = reserve.exchange(nullptr);
  if (kept == nullptr) throw std::bad_alloc();
  std::free(kept);
}

}  // namespace

void keep_memory_in_reserve() {
  if (reserve != nullptr) return;
  std::free(reserve.exchange(std::malloc(kBytes)));
  std::set_new_handler(give_it_up);
}

}  // namespace shaken
