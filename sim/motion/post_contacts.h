#pragma once

#include "sim/motion/flight.h"
#include "sim/motion/post_grid.h"
#include "sim/motion/side_walls.h"
#include "sim/rod/species.h"

namespace shaken {

/// The post whose axis stands at `axis`, as a bead with its centre at `point` sees it. Numerics: on the axis itself the
/// normal is along x.
WallSeen see_post(const Vec2& axis, double radius, const Vec3& point);

/// Whether a bead of the rod may touch a post. If not, none of them does.
bool may_touch_posts(const PostGrid& posts, const Species& species, const Pose& pose);

/// No bead of the rod touches a post.
bool is_clear_of_posts(const PostGrid& posts, const Species& species, const Pose& pose);

/// Deepest overlap of a bead of the rod and a post; 0 if there is none [mm].
double overlap_with_posts(const PostGrid& posts, const Species& species, const Pose& pose);

/// Time for which no bead of a flying rod touches a post; 0 if one does, at most `horizon` [s]. Rigorous.
///
/// Model: a bead that is at p from the axis of a post and moves with u in the plane now is within b t^2 of p + u t
/// later, as at side walls (wall_safe_time). It meets the post, of radius R with its own, no earlier than
/// - the tangent of the post at the point nearest to p, behind which all of the post lies: w t + b t^2 = |p| - R, where
///   w is the speed towards it;
/// - |p + u t| = R + b T^2 for t up to any T, of which a few are tried: the very time, if the rod does not turn.
/// The latest of these is the bound. Posts are looked for no farther than a rod gets within a cell of the grid; until
/// it has flown so far, it meets no other. Numerics: posts are taken to be thicker by a margin for rounding, 1e-9
/// of the lengths that places are given by.
/// Arguments: `flight` with its velocity of now, and `pull`, the acceleration along the plane [mm/s^2], which bends
/// each path by pull t^2 / 2 at most.
double post_safe_time(const PostGrid& posts, const Box& box, const Species& species, const Pose& pose,
                      const Flight& flight, double horizon, double pull);

}  // namespace shaken
