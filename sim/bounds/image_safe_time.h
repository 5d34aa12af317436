#pragma once

#include <algorithm>
#include <cmath>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/bounds/safe_time.h"

namespace shaken {

/// Time for which no image of rod j can touch rod i but the one that is nearest now, at most `horizon` [s]. The other
/// bounds on a pair are of that image alone, and hold for the pair no longer than this.
/// Model:  every other image is a box further along x or y, so its centre is at least L - |D_x| away along x, or
///         L - |D_y| along y; it comes nearer no faster than the centres move along that axis; and where rods touch,
///         their centres are no further apart than `reach` along any axis. In a box that is wide enough
///         (least_box_side) the time is never 0.
/// Arguments: D from centre i to the nearest centre j [mm], `reach` the sum of both rods' (Species::reach()) [mm].
inline float image_safe_time(const Vec3& D, const FlightBound& i, const FlightBound& j, const Box& box, double reach,
                             float horizon) {
  float safe = horizon;
  for (int c = 0; c < 2; ++c) {
    const auto room =
        static_cast<float>((box[c] - std::abs(D[c]) - reach) - margins::kImageRoom * box[c]);  // less the rounding
    const float speed = std::abs(j.velocity[c] - i.velocity[c]) + (i.velocity_rounding + j.velocity_rounding);
    const float open = std::max(room, 0.0F) * (1.0F - margins::kTime);
    if (speed * safe > open) safe = open / speed;
  }
  return safe;
}

/// Whether no other image of rod j can come to touch rod i within `horizon` [s] if neither moves faster than `speed`
/// along x or y [mm/s].
inline bool images_stay_away(const Vec3& D, const Box& box, double reach, double speed, double horizon) {
  const Vec2 open = box.sides() * (1 - margins::kImageRoom) - D.head<2>().cwiseAbs();
  const double room = open.minCoeff() - reach;
  return room > 2 * speed * horizon;
}

}  // namespace shaken
