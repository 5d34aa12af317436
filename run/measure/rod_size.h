// SPDX-License-Identifier: MIT
#pragma once

#include "sim/rod/species.h"

namespace shaken::run {

/// From tip to tip [mm].
inline double rod_length(const Species& species) {
  return species.tail.length + species.tail.radius + species.head.length + species.head.radius;
}

/// Where the rod is widest [mm].
inline double rod_width(const Species& species) { return 2 * species.max_radius; }

}  // namespace shaken::run
