#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// How many rods changed sides, in how much time of theirs.
struct SwitchSums : Summed<SwitchSums> {
  double switches = 0;
  double lived = 0;  ///< by all rods whose side is known, together [s]

  void accumulate(const SwitchSums& other) { merge(other); }
  static auto fields(auto& self) { return listed(self.switches, self.lived); }
};

/// How long rods stay tilted to one side. A rod is up, head higher than tail, from when its n_z rises beyond
/// `threshold` until it falls below -`threshold`, and down from then on: what turns back in between has not switched
/// (a comparator with hysteresis: Schmitt, J. Sci. Instrum. 15, 24 (1938)). The switching time is the time that all
/// rods lived, each from when its side is first known, over the number of their switches: the mean time from one switch
/// to the next, whatever the run's ends cut off. Switches there and back between two samples are missed, so it is at
/// least about the interval. Memory: 8 bytes a rod, and 64 blocks.
class TiltSwitches : public Saved<TiltSwitches> {
 public:
  explicit TiltSwitches(double threshold);

  /// Directors (n_rods) at `time` [s], later than all before; n_rods is the same in every call.
  void accumulate(double time, std::span<const Vec3> directors);
  const Blocked<SwitchSums>& sums() const { return blocks_; }
  /// Mean time from switch to switch [s]; NaN where no rod has switched.
  static double switching_time(const SwitchSums& sums);

  static constexpr const char* kName = "TiltSwitches";
  static auto fields(auto& self) {
    return listed(Setting{"threshold", self.threshold_}, self.last_time_, Growing{self.sides_}, self.blocks_);
  }

 private:
  double threshold_;
  double last_time_ = -std::numeric_limits<double>::infinity();
  std::vector<std::int64_t> sides_;  // (n_rods) +1 up, -1 down, 0 not yet known
  Blocked<SwitchSums> blocks_{SwitchSums{}};
};

}  // namespace shaken::analysis
