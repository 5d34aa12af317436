// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/core/types.h"

namespace shaken::run {

inline constexpr Tick kNever = std::numeric_limits<Tick>::max();

/// Something that happens every so many ticks, from tick 0 on.
class Cadence {
 public:
  /// Every `seconds`, rounded to whole ticks, at least one.
  Cadence(double seconds, double dt) : period_(std::max<Tick>(1, std::llround(seconds / dt))) {}

  Tick period() const { return period_; }
  bool due(Tick tick) const { return tick % period_ == 0; }
  /// The first tick >= `from` at which it happens.
  Tick next(Tick from) const { return (from + period_ - 1) / period_ * period_; }

 private:
  Tick period_;
};

}  // namespace shaken::run
