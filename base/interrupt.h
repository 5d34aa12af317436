#pragma once

#include <chrono>

namespace shaken {

/// While it lives, SIGINT, SIGTERM and SIGHUP no longer end the program: they are noted, for loops that must leave the
/// terminal in order.
class InterruptGuard {
 public:
  InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard();

  /// Whether a signal has come.
  bool interrupted() const;
  /// Waits, but no longer than until a signal comes.
  void sleep_for(std::chrono::milliseconds time) const;
};

}  // namespace shaken
