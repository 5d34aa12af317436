#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

namespace shaken::run {

using WallClock = std::chrono::steady_clock;  // never set back, unlike the time of day
using WallSeconds = std::chrono::duration<double>;

/// Something that should happen at most so often in wall time.
class Pacer {
 public:
  explicit Pacer(WallSeconds period, WallClock::time_point first)
      : period_(std::chrono::duration_cast<WallClock::duration>(period)), next_(first) {}

  /// Whether it is time; if so, the next time is a period later.
  bool take(WallClock::time_point now) {
    if (now < next_) return false;
    next_ = now + period_;
    return true;
  }

 private:
  WallClock::duration period_;
  WallClock::time_point next_;
};

/// Simulated seconds per wall second, averaged over the last few seconds.
class RateMeter {
 public:
  RateMeter(double sim_time, WallClock::time_point now) : begin_(now), sim_time_(sim_time), now_(now) {}

  /// Takes the state of things; calls that follow each other too fast to tell a rate are left out.
  void update(double sim_time, WallClock::time_point now) {
    constexpr double kShortest = 0.05;  // [s]
    constexpr double kMemory = 5.0;     // [s]
    const double elapsed = WallSeconds(now - now_).count();
    if (elapsed < kShortest) return;
    // At first a plain average since the beginning, later one that forgets.
    const double weight = std::max(1 - std::exp(-elapsed / kMemory), elapsed / WallSeconds(now - begin_).count());
    rate_ += weight * ((sim_time - sim_time_) / elapsed - rate_);
    sim_time_ = sim_time;
    now_ = now;
  }
  double rate() const { return rate_; }  ///< 0 until it is known
  /// Wall seconds from the last update to `sim_time_total`; negative where unknown.
  double eta(double sim_time_total) const { return rate_ > 0 ? (sim_time_total - sim_time_) / rate_ : -1.0; }

 private:
  WallClock::time_point begin_;
  double sim_time_;
  WallClock::time_point now_;
  double rate_ = 0;
};

}  // namespace shaken::run
