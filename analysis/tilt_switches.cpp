#include "analysis/tilt_switches.h"

#include <cmath>

#include "analysis/bins.h"
#include "base/core/check.h"

namespace shaken::analysis {

TiltSwitches::TiltSwitches(double threshold) : threshold_(threshold) {
  SHAKEN_CHECK(threshold > 0, "between up and down there is something");
}

void TiltSwitches::accumulate(double time, std::span<const Vec3> directors) {
  SHAKEN_CHECK(time > last_time_, "samples must come in order of time");
  const bool first = !std::isfinite(last_time_);
  if (first) sides_.assign(directors.size(), 0);
  SHAKEN_CHECK(sides_.size() == directors.size(), "as many rods as before");
  SwitchSums sums;
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const double n_z = directors[i].z();
    const std::int64_t before = sides_[i];
    if (before != 0) sums.lived += time - last_time_;
    if (std::abs(n_z) <= threshold_) continue;
    sides_[i] = n_z > 0 ? 1 : -1;
    if (before != 0 && sides_[i] != before) sums.switches += 1;
  }
  blocks_.accumulate(time, sums);
  last_time_ = time;
}

double TiltSwitches::switching_time(const SwitchSums& sums) { return mean_of(sums.lived, sums.switches); }

}  // namespace shaken::analysis
