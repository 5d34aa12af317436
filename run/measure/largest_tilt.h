#pragma once

#include <algorithm>

#include "sim/rod/species.h"

namespace shaken::run {

/// The largest |n_z| of a rod that touches both plates without overlap, at most 1.
inline double largest_tilt(const Species& species, double gap) {
  if (species.half_length <= 0) return 1.0;
  return std::clamp((gap / 2 - species.end_radius) / species.half_length, 0.0, 1.0);
}

}  // namespace shaken::run
