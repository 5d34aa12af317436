#pragma once

#include <algorithm>
#include <array>
#include <optional>

namespace shaken {

/// Decides by trial whether several threads that share the loops of a tick are faster than one alone. They are not
/// where other programs want the same cores: whoever is done first then waits until the other gets a core again.
///
/// In a trial, stretches of ticks are shared and not shared in turn, and timed. Whichever took less time is done from
/// then on; the next trial comes after some time, and later and later as long as the answer stays the same. Ticks that
/// are shared meanwhile are timed too: once they take longer than those alone did in the trial, sharing ends.
///
/// The clock is lent from outside. A trial has no influence on any trajectory: sharing does not change a bit.
class SharingTrial {
 public:
  using Clock = double (*)();  ///< time on the wall since whenever [s]

  static constexpr int kStretch = 256;   ///< [ticks]
  static constexpr int kUntimed = 16;    ///< first ticks of a stretch, in which data move between caches
  static constexpr int kPairs = 8;       ///< of stretches in a trial, at most
  static constexpr int kLeastPairs = 3;  ///< before a trial that is clear ends early
  static constexpr double kClear = 1.5;  ///< ratio of times from which on it is
  static constexpr double kHopeless =
      3;  ///< a stretch that is shared is cut short after so many times that of one alone
  static constexpr double kWorth = 1.05;  ///< threads must be so much faster, for they take more CPU time
  /// Ticks from one trial to the next.
  static constexpr int kLeastWait = 4 * 2 * kPairs * kStretch;
  static constexpr int kMostWait = 8 * kLeastWait;
  static constexpr int kWatch = kLeastWait / 8;  ///< ticks that are timed together between trials

  /// From now on trials are made by `clock`, the first one at once; nullptr ends them, and loops are always shared.
  void use(Clock clock) {
    *this = {};
    clock_ = clock;
    begin_trial();
  }

  /// To be called at the beginning of each tick: whether its loops are to be shared.
  bool next_tick() {
    if (clock_ == nullptr) return true;
    if (ticks_left_ == 0) is_trying_ ? end_stretch() : begin_trial();
    if (is_trying_ && shares_ && is_hopeless()) decide(false);
    if (is_trying_ && ticks_left_ == kStretch - kUntimed) began_ = clock_();
    if (!is_trying_ && shares_ && ticks_left_ % kWatch == 0) watch();
    --ticks_left_;
    return shares_;
  }

 private:
  void begin_trial() {
    is_trying_ = true;
    n_stretches_ = 0;
    seconds_ = {};
    begin_stretch();
  }

  /// Alone, shared, shared, alone, ...: what changes slowly counts for both alike.
  void begin_stretch() {
    shares_ = n_stretches_ % 4 == 1 || n_stretches_ % 4 == 2;
    ticks_left_ = kStretch;
  }

  void end_stretch() {
    seconds_[shares_ ? 1 : 0] += clock_() - began_;
    ++n_stretches_;
    if (is_over()) {
      decide(seconds_[0] > kWorth * seconds_[1]);
    } else {
      begin_stretch();
    }
  }

  bool is_over() const {
    if (n_stretches_ % 2 != 0 || n_stretches_ < 2 * kLeastPairs) return false;
    const auto& [alone, shared] = seconds_;
    return n_stretches_ == 2 * kPairs || std::max(alone, shared) > kClear * std::min(alone, shared);
  }

  /// Where all cores are taken, a tick that is shared can take a hundred times as long.
  bool is_hopeless() {
    const double now = clock_();
    if (ticks_left_ == kStretch) stretch_began_ = now;
    return now - stretch_began_ > kHopeless * kStretch * alone();
  }

  /// Time of a tick alone, by the stretches so far: of two pairs the first and the last are [s].
  double alone() const {
    const int n = n_stretches_ / 4 * 2 + (n_stretches_ % 4 == 0 ? 0 : 1);
    return seconds_[0] / (n * (kStretch - kUntimed));
  }

  void decide(bool shares) {
    alone_ = alone();
    shares_ = shares;
    wait_ = shares_ == answer_ ? std::min(2 * wait_, kMostWait) : kLeastWait;
    answer_ = shares_;
    is_trying_ = false;
    ticks_left_ = wait_;
  }

  void watch() {
    const double now = clock_();
    const bool is_slow = ticks_left_ < wait_ && now - began_ > kWatch * alone_;
    began_ = now;
    if (!is_slow) return;
    shares_ = false;
    answer_ = false;
    ticks_left_ = wait_ = kLeastWait;
  }

  Clock clock_ = nullptr;
  bool is_trying_ = false;
  bool shares_ = true;
  int ticks_left_ = 0;               ///< of the stretch, or of the wait for the next trial
  int n_stretches_ = 0;              ///< of the trial that are over
  double began_ = 0;                 ///< the ticks that are timed [s]
  double stretch_began_ = 0;         ///< that is shared [s]
  double alone_ = 0;                 ///< time of a tick alone, in the last trial [s]
  std::array<double, 2> seconds_{};  ///< that stretches of this trial took, those alone and those shared
  std::optional<bool> answer_;       ///< of the last trial
  int wait_ = kLeastWait;            ///< after it [ticks]
};

}  // namespace shaken
