// Small defects behind a switch, for `./dev mutants`: put in front of each file of a copy of the source tree. The
// environment variable SHAKEN_MUTANT turns one of them on; SHAKEN_MUTANTS_SEEN names a file to which the numbers of
// those are added whose places the program came to.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <utility>

namespace shaken_mutants {

struct Switch {
  static constexpr int kMost = 1 << 16;
  int on = -1;
  const char* seen_file = std::getenv("SHAKEN_MUTANTS_SEEN");
  std::atomic<bool> seen[kMost] = {};

  Switch() {
    if (const char* number = std::getenv("SHAKEN_MUTANT")) on = std::atoi(number);
  }
  void see(int k) {
    if (seen[k].exchange(true)) return;  // at once: programs may end by a signal
    const std::string line = std::to_string(k) + "\n";
    const int file = ::open(seen_file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) return;
    if (::write(file, line.data(), line.size()) < 0) std::abort();
    ::close(file);
  }
};

inline Switch& the_switch() {
  static Switch one;
  return one;
}

inline bool is_on(int k) {
  Switch& all = the_switch();
  if (all.seen_file != nullptr) [[unlikely]]
    all.see(k);
  return all.on == k;
}

template <class T>
T either(int k, T right, T wrong) {
  return is_on(k) ? wrong : right;
}
/// One of two arguments of one type; others do not compile, and are no mutants.
template <class T>
const T& either_of(int k, const T& right, const T& wrong) {
  return is_on(k) ? wrong : right;
}
template <class Condition>
bool flipped(int k, const Condition& condition) {
  return static_cast<bool>(condition) != is_on(k);
}
/// Of a condition that an error occurred.
template <class Condition>
bool ignored(int k, const Condition& failed) {
  return static_cast<bool>(failed) && !is_on(k);
}

// a < b is written as a < Less{k} > b: the first operator takes the left operand along, the second does the work.
#define SHAKEN_MUTANT_OPERATOR(Name, first, last, right, wrong)                       \
  struct Name {                                                                       \
    int k;                                                                            \
  };                                                                                  \
  template <class A>                                                                  \
  struct Name##After {                                                                \
    const A& a;                                                                       \
    int k;                                                                            \
  };                                                                                  \
  template <class A>                                                                  \
  Name##After<A> operator first(const A& a, Name mutant) {                            \
    return {a, mutant.k};                                                             \
  }                                                                                   \
  template <class A, class B>                                                         \
  auto operator last(Name##After<A> before, const B& b)->decltype(before.a right b) { \
    return is_on(before.k) ? before.a wrong b : before.a right b;                     \
  }

SHAKEN_MUTANT_OPERATOR(Less, <, >, <, <=)
SHAKEN_MUTANT_OPERATOR(Greater, >, <, >, >=)
SHAKEN_MUTANT_OPERATOR(AtMost, <=, >=, <=, <)
SHAKEN_MUTANT_OPERATOR(AtLeast, >=, <=, >=, >)
SHAKEN_MUTANT_OPERATOR(Equal, ==, !=, ==, !=)
SHAKEN_MUTANT_OPERATOR(Unequal, !=, ==, !=, ==)
SHAKEN_MUTANT_OPERATOR(Plus, +, -, +, -)
SHAKEN_MUTANT_OPERATOR(Minus, -, +, -, +)
SHAKEN_MUTANT_OPERATOR(Times, *, /, *, /)
SHAKEN_MUTANT_OPERATOR(Over, /, *, /, *)

}  // namespace shaken_mutants
