// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "sim/motion/flight.h"
#include "sim/rod/species.h"
#include "sim/system.h"

namespace shaken {

/// One wall as a bead sees it.
struct WallSeen {
  double distance = 0;         ///< of the bead's centre, positive inside of the arena [mm]
  Vec3 normal = Vec3::Zero();  ///< from the wall into the arena
};

/// The walls nearest to a point of the plane: one of a disc, two of a square or an annulus.
struct WallsSeen {
  std::array<WallSeen, 2> walls;
  int n = 0;
};
WallsSeen see_walls(const SideWalls& walls, double box_side, const Vec3& point);

/// Distance of a point to the nearest wall, negative outside of the arena [mm]. No faster than the point itself.
double distance_to_walls(const SideWalls& walls, double box_side, const Vec3& point);

/// No bead of the rod touches a wall.
bool is_within(const SideWalls& walls, double box_side, const Species& species, const Pose& pose);

/// Time for which no bead of a flying rod touches a wall; 0 if one does, at most `horizon` [s]. Rigorous: no bead is
/// faster in the plane than the centre's speed there plus |s| times the precession's rate.
double wall_safe_time(const SideWalls& walls, double box_side, const Species& species, const Pose& pose,
                      const Flight& flight, double horizon);

}  // namespace shaken
