#pragma once

#include <array>
#include <cmath>

#include "base/core/box.h"
#include "sim/motion/flight.h"
#include "sim/rod/species.h"
#include "sim/system.h"

namespace shaken {

/// One wall, or one post, as a bead sees it.
struct WallSeen {
  double distance = 0;         ///< of the bead's centre, positive inside of the arena [mm]
  Vec3 normal = Vec3::Zero();  ///< from the wall into the arena
};

/// The walls nearest to a point of the plane: two of a square or an annulus; three of a wedge, the nearer of its ends
/// and both slanting ones, between which a bead may be; one of any other arena.
struct WallsSeen {
  static constexpr int kMost = 3;
  std::array<WallSeen, kMost> walls;
  int n = 0;
};
/// An ellipse that is clearly further than `reach` is left out: where it is costs an iteration.
WallsSeen see_walls(const SideWalls& walls, const Box& box, const Vec3& point, double reach = INFINITY);

/// Distance of a point to the nearest wall, negative outside of the arena [mm]. No faster than the point itself. It may
/// be infinite where it is clearly more than `reach`.
double distance_to_walls(const SideWalls& walls, const Box& box, const Vec3& point, double reach = INFINITY);

/// No bead of the rod touches a wall.
bool is_within(const SideWalls& walls, const Box& box, const Species& species, const Pose& pose);

/// Whether a bead of the rod may touch a wall. If not, `see_walls` finds that none of them does.
///
/// Model: with p = c + s n the points of the rod's axis, seen from the middle of the arena, an outer wall is as near as
/// |p| or |p_x| or |p_y| is large, or in a stadium the distance of p to the line between the centres of its round ends,
/// or in general as the distance to the border of a convex arena is small. These are convex in s, and that distance
/// concave. So is what a bead reaches, that plus its radius, if radii go along the straight lines between the outer
/// beads; no bead is thicker. So an outer bead reaches farthest. At an inner
/// wall it may be any bead, but none is nearer to the middle than the nearest point of the axis, or thicker than the
/// hull. Numerics: squares, and a margin for rounding; a rod that misses a wall by less may be said to touch it.
bool may_touch_walls(const SideWalls& walls, const Box& box, const Species& species, const Pose& pose);

/// Time for which no bead of a flying rod touches a wall; 0 if one does, at most `horizon` [s]. Rigorous.
///
/// Model: in the plane, a bead that is at p and moves with u = v + s W x n now is within b t^2 of p + u t later, where
/// b = |s| W^2 / 2, because |n''| <= W^2. What meets an outer wall first is an outer bead (see may_touch_walls):
/// - a straight one at the distance d, towards which it moves at the speed w, no earlier than w t + b t^2 = d;
/// - a round one of radius R no earlier than |p + u t|^2 = R^2 - 2 R b t^2, which is at most (R - b t^2)^2: another
///   quadratic in t, and without a bend the very time;
/// - a round end of a stadium no earlier than it comes to where the straight walls end, nor than its circle;
/// - an ellipse no earlier than the rim of any disc within it that the bead lies in (sim/motion/ellipse.h).
/// An inner wall lies behind its tangent at the point nearest to p, so each bead meets it no earlier than it would meet
/// a straight wall there. Numerics: all walls are taken to be nearer by a margin for rounding, 1e-9 of the box.
/// Arguments: `flight` with its velocity of now, and `pull`, the acceleration along the plane [mm/s^2], which bends
/// each path by pull t^2 / 2 at most.
double wall_safe_time(const SideWalls& walls, const Box& box, const Species& species, const Pose& pose,
                      const Flight& flight, double horizon, double pull);

}  // namespace shaken
