#pragma once

#include <array>
#include <cstddef>

namespace shaken {

/// What a stepper spends its time on. The first four are the tick itself (tick/tick.h); the others are what it
/// takes to know where to look.
enum class Phase { kSurfaces, kDetection, kResponse, kStoring, kRodBounds, kShortening, kPairBounds, kNeighbors };
inline constexpr std::size_t kPhases = 8;
inline constexpr std::array<const char*, kPhases> kPhaseNames{"surfaces",   "detection",  "response",    "storing",
                                                              "rod_bounds", "shortening", "pair_bounds", "neighbors"};

/// Seconds per phase, by a clock that the caller lends: the physics library has none. Without one, a tick reads no
/// clock and a lap costs one branch.
class PhaseTimes {
 public:
  using Clock = double (*)();  ///< seconds since whenever

  void use(Clock clock) { clock_ = clock; }
  /// The time up to the next lap() belongs to no phase yet.
  void start() {
    if (clock_ != nullptr) last_ = clock_();
  }
  /// Adds the time since the last lap to `phase`.
  void lap(Phase phase) {
    if (clock_ == nullptr) return;
    const double now = clock_();
    seconds_[static_cast<std::size_t>(phase)] += now - last_;
    last_ = now;
  }
  double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }

  /// What lies between these two could be shared among threads.
  void begin_loop() {
    if (clock_ != nullptr) loop_began_ = clock_();
  }
  void end_loop() {
    if (clock_ != nullptr) in_loops_ += clock_() - loop_began_;
  }
  /// Seconds of all phases that could be shared among threads.
  double in_loops() const { return in_loops_; }

 private:
  Clock clock_ = nullptr;
  double last_ = 0;
  double loop_began_ = 0;
  double in_loops_ = 0;
  std::array<double, kPhases> seconds_{};
};

}  // namespace shaken
