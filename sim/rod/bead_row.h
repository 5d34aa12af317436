// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace shaken {

/// The beads of one species, from tail to head, equally spaced.
struct BeadRow {
  std::vector<double> offset;  ///< (n_beads) of the centres along the rod, from the rod's centre [mm]
  std::vector<double> radius;  ///< (n_beads) [mm]
  friend bool operator==(const BeadRow&, const BeadRow&) = default;
};

}  // namespace shaken
