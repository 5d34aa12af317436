// SPDX-License-Identifier: MIT
#include "sim/motion/side_walls.h"

#include <algorithm>
#include <cmath>

namespace shaken {

WallsSeen see_walls(const SideWalls& walls, double box_side, const Vec3& point) {
  const double x = point.x() - 0.5 * box_side;
  const double y = point.y() - 0.5 * box_side;
  const double half = 0.5 * walls.size;
  if (walls.arena == Arena::kSquare) {
    const Vec3 from_x(x > 0 ? -1.0 : 1.0, 0, 0);
    const Vec3 from_y(0, y > 0 ? -1.0 : 1.0, 0);
    return {{WallSeen{half - std::abs(x), from_x}, WallSeen{half - std::abs(y), from_y}}, 2};
  }
  const double r = std::sqrt(x * x + y * y);
  const Vec3 inwards = r > 0 ? Vec3(-x / r, -y / r, 0) : Vec3(1, 0, 0);
  const WallSeen outer{half - r, inwards};
  if (walls.arena == Arena::kDisc) return {{outer, WallSeen{}}, 1};
  return {{outer, WallSeen{r - 0.5 * walls.inner, -inwards}}, 2};
}

double distance_to_walls(const SideWalls& walls, double box_side, const Vec3& point) {
  const WallsSeen seen = see_walls(walls, box_side, point);
  return seen.n == 1 ? seen.walls[0].distance : std::min(seen.walls[0].distance, seen.walls[1].distance);
}

bool is_within(const SideWalls& walls, double box_side, const Species& species, const Pose& pose) {
  for (int b = 0; b < species.n_beads(); ++b) {
    const Vec3 center = pose.position + species.bead_offset[b] * pose.director;
    if (distance_to_walls(walls, box_side, center) < species.bead_radius[b]) return false;
  }
  return true;
}

double wall_safe_time(const SideWalls& walls, double box_side, const Species& species, const Pose& pose,
                      const Flight& flight, double horizon) {
  const double speed = std::hypot(flight.velocity.x(), flight.velocity.y()) + species.half_length * flight.rate;
  double gap = distance_to_walls(walls, box_side, pose.position) - species.half_length - species.max_radius;
  if (gap < speed * horizon) {  // near enough for the beads themselves to matter
    gap = horizon * speed + 1.0;
    for (int b = 0; b < species.n_beads(); ++b) {
      const Vec3 center = pose.position + species.bead_offset[b] * pose.director;
      gap = std::min(gap, distance_to_walls(walls, box_side, center) - species.bead_radius[b]);
    }
  }
  gap -= 1e-9 * (1.0 + box_side);  // rounding
  if (!(gap > 0)) return 0.0;
  return speed * horizon > gap ? gap / speed : horizon;
}

}  // namespace shaken
