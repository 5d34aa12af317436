// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace shaken {

/// How far ahead in a list a loop asks for what it will need: long enough for memory to answer.
inline constexpr int kAhead = 6;

/// Asks for a record that will be needed soon. With many rods, what a tick needs lies scattered over more memory than
/// the near caches hold, but it is known some steps ahead.
template <class T>
inline void prefetch(const T& record) {
  const char* const bytes = reinterpret_cast<const char*>(&record);
  for (std::size_t at = 0; at < sizeof(T); at += 64) __builtin_prefetch(bytes + at);
}

/// Calls visit(item) for list[begin, end), and ask(item) for each some steps before.
template <class List, class Ask, class Visit>
void visit_ahead(const List& list, int begin, int end, const Ask& ask, const Visit& visit) {
  for (int k = begin; k < end && k < begin + kAhead; ++k) ask(list[k]);
  for (int k = begin; k < end; ++k) {
    if (k + kAhead < end) ask(list[k + kAhead]);
    visit(list[k]);
  }
}

}  // namespace shaken
