#pragma once

#include <algorithm>

#include "base/core/types.h"
#include "run/live/pace.h"

namespace shaken::run {

/// Longest that a simulation is stepped without a look at what else there is to do: short enough to answer a signal,
/// long enough not to matter.
inline constexpr WallSeconds kLongSlice{0.1};

/// How far a simulation is stepped at once. The length follows the speed, so that none lasts much longer than it may.
class Slice {
 public:
  explicit Slice(WallSeconds longest = kLongSlice) : longest_(longest) {}
  Tick end(Tick first) const { return first + ticks_; }
  /// So many ticks, at most a slice, were stepped within `spent`.
  void note(Tick stepped, WallSeconds spent) {
    if (spent > longest_) ticks_ = std::max<Tick>(1, stepped / 2);
    if (spent < longest_ / 5 && stepped == ticks_) ticks_ *= 2;
  }

 private:
  WallSeconds longest_;
  Tick ticks_ = 1;
};

}  // namespace shaken::run
