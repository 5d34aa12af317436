#pragma once

#include <algorithm>
#include <cmath>

namespace shaken::analysis {

/// Whether `time` belongs to the steady state that begins at `t_steady` [s]. Times are tick * dt, so a sample meant to
/// be taken at t_steady may lie below it by rounding; it belongs.
inline bool is_steady(double time, double t_steady) {
  return time >= t_steady - 1e-9 * std::max(1.0, std::abs(t_steady));
}

}  // namespace shaken::analysis
