#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/core/rng.h"
#include "base/core/types.h"

namespace shaken::run {

inline constexpr Tick kNever = std::numeric_limits<Tick>::max();

/// Something that happens once in every so many ticks, from tick 0 on: at the first tick of each interval, or, spread,
/// at one that is drawn for it. What is spread meets whatever else recurs, such as the plates' vibration, at all of its
/// phases alike. Both depend on the tick alone, so that a restart changes nothing.
class Cadence {
 public:
  /// Every `seconds`, rounded to whole ticks, at least one.
  Cadence(double seconds, double dt) : period_(std::max<Tick>(1, std::llround(seconds / dt))) {}
  /// The same, at ticks that are drawn from `seed`.
  static Cadence spread(double seconds, double dt, std::uint64_t seed) {
    Cadence cadence(seconds, dt);
    cadence.seed_ = seed;
    return cadence;
  }

  Tick period() const { return period_; }
  bool due(Tick tick) const { return tick == in_interval(tick / period_); }
  /// The first tick >= `from` at which it happens.
  Tick next(Tick from) const {
    const Tick here = in_interval(from / period_);
    return here >= from ? here : in_interval(from / period_ + 1);
  }
  /// How often it happens up to tick `last`.
  Tick count(Tick last) const { return last / period_ + (in_interval(last / period_) <= last ? 1 : 0); }

 private:
  /// The tick of the interval with this number.
  Tick in_interval(Tick number) const {
    if (!seed_) return number * period_;
    return number * period_ +
           static_cast<Tick>(Rng(*seed_, RngStream::kSamples, number, 0).below(static_cast<std::uint64_t>(period_)));
  }

  Tick period_;
  std::optional<std::uint64_t> seed_;  ///< none: always the first tick
};

}  // namespace shaken::run
