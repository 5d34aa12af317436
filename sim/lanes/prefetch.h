#pragma once

#include <algorithm>
#include <cstddef>

namespace shaken {

/// How far ahead in a list a loop asks for what it will need: long enough for memory to answer.
inline constexpr std::size_t kAhead = 6;

/// Asks for the line of memory, 64 bytes, that holds what is there.
inline void prefetch_line(const void* at) {
  __builtin_prefetch(at);
  asm volatile("");  // or else g++ takes functions that do nothing else for ones without effect, and drops their calls
}

/// Asks for a record that will be needed soon. With many rods, what a tick needs lies scattered over more memory than
/// the near caches hold, but it is known some steps ahead.
template <class T>
inline void prefetch(const T& record) {
  constexpr std::size_t kLine = 64;
  const char* const bytes = reinterpret_cast<const char*>(&record);
  for (std::size_t at = 0; at < sizeof(T); at += kLine) prefetch_line(bytes + at);
  constexpr std::size_t kLatestStart = kLine - std::min(kLine, alignof(T));
  if constexpr ((kLatestStart + sizeof(T) - 1) / kLine > (sizeof(T) - 1) / kLine) prefetch_line(bytes + sizeof(T) - 1);
}

/// Calls visit(item) for each item of a list, and ask(item) some steps before.
template <class List, class Ask, class Visit>
void for_each_prefetched(const List& list, const Ask& ask, const Visit& visit) {
  const std::size_t n = list.size();
  for (std::size_t k = 0; k < n && k < kAhead; ++k) ask(list[k]);
  for (std::size_t k = 0; k < n; ++k) {
    if (k + kAhead < n) ask(list[k + kAhead]);
    visit(list[k]);
  }
}

}  // namespace shaken
