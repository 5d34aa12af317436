#include "sim/motion/post_contacts.h"

#include <algorithm>
#include <cmath>

namespace shaken {
namespace {

Vec2 in_plane(const Vec3& vector) { return vector.head<2>(); }

/// A rod touches no post whose axis is farther from the rod's centre [mm].
double reach_of_rod(const PostGrid& posts, const Species& species) {
  return posts.radius() + species.half_length + species.max_radius;
}

/// Where a bead is from the axis of a post, and where it goes: at time t it is within bend t^2 of from + velocity t.
struct BeadByPost {
  Vec2 from;
  Vec2 velocity;
  double bend;
};

/// The first time t > 0 with w t + b t^2 = gap, where b >= 0 and gap > 0; at most `time`. Numerics: of the root's two
/// forms, that in which nothing cancels.
double time_to_tangent(double gap, double speed, double bend, double time) {
  if (!((bend * time + speed) * time > gap)) return time;
  const double half = 0.5 * speed;
  const double root = std::sqrt(half * half + bend * gap);
  return half > 0 ? gap / (half + root) : (root - half) / bend;
}

/// The first time at which a point at `from`, outside of a circle of this radius about 0, comes to it; at most `time`.
double time_to_circle(const Vec2& from, const Vec2& velocity, double radius, double time) {
  const double room = from.squaredNorm() - radius * radius;
  if (!(room > 0)) return 0.0;
  const double towards = -from.dot(velocity);
  const double root2 = towards * towards - velocity.squaredNorm() * room;
  if (!(towards > 0 && root2 > 0)) return time;
  return std::min(time, room / (towards + std::sqrt(root2)));
}

/// The first time at which a bead may touch a post, with both radii in `radius`; at most `time`.
double time_to_post(const BeadByPost& bead, double radius, double time) {
  const double distance = bead.from.norm();
  if (!(distance > radius)) return 0.0;
  const double speed = -bead.from.dot(bead.velocity) / distance;
  const double to_tangent = time_to_tangent(distance - radius, speed, bead.bend, time);
  if (to_tangent >= time) return time;
  // Up to t it comes no nearer to the post than bend t^2 from where it would be without a bend.
  const auto up_to = [&](double t) { return time_to_circle(bead.from, bead.velocity, radius + bead.bend * t * t, t); };
  double bound = std::max(to_tangent, up_to(time));
  if (bead.bend == 0) return bound;
  double least_wrong = time;
  for (int k = 0; k < 4 && bound < least_wrong; ++k) {
    const double t = 0.5 * (bound + least_wrong);
    const double safe = up_to(t);
    if (safe < t) least_wrong = t;
    bound = std::max(bound, safe);
  }
  return bound;
}

}  // namespace

WallSeen see_post(const Vec2& axis, double radius, const Vec3& point) {
  const Vec2 from = in_plane(point) - axis;
  const double distance = from.norm();
  return {distance - radius, distance > 0 ? Vec3(from.x() / distance, from.y() / distance, 0) : Vec3(1, 0, 0)};
}

bool may_touch_posts(const PostGrid& posts, const Species& species, const Pose& pose) {
  bool may = false;
  const double rounding = 1e-9 * (1.0 + pose.position.head<2>().cwiseAbs().maxCoeff());
  posts.for_each_within(in_plane(pose.position), reach_of_rod(posts, species) + rounding,
                        [&](int, const Vec2&) { may = true; });
  return may;
}

double overlap_with_posts(const PostGrid& posts, const Species& species, const Pose& pose) {
  if (!may_touch_posts(posts, species, pose)) return 0;
  double most = 0;
  for (int b = 0; b < species.n_beads(); ++b) {
    const Vec3 center = pose.position + species.bead_offset[b] * pose.director;
    const double radius = species.bead_radius[b];
    posts.for_each_within(in_plane(center), posts.radius() + radius, [&](int, const Vec2& axis) {
      most = std::max(most, radius - see_post(axis, posts.radius(), center).distance);
    });
  }
  return most;
}

bool is_clear_of_posts(const PostGrid& posts, const Species& species, const Pose& pose) {
  return !(overlap_with_posts(posts, species, pose) > 0);
}

double post_safe_time(const PostGrid& posts, const Box& box, const Species& species, const Pose& pose,
                      const Flight& flight, double horizon, double pull) {
  const Vec2 center = in_plane(pose.position), velocity = in_plane(flight.velocity);
  const double margin = 1e-9 * (1.0 + box.longer() + center.cwiseAbs().maxCoeff());
  const double fastest = velocity.norm() + pull * horizon + species.half_length * flight.rate;  // of its beads
  double time = fastest * horizon > posts.spacing() ? posts.spacing() / fastest : horizon;

  const Vec2 along = in_plane(pose.director);
  const Vec2 turning = in_plane(flight.precession.cross(pose.director));
  const double along2 = along.squaredNorm();
  const double reach = reach_of_rod(posts, species) + margin + fastest * time;
  posts.for_each_within(center, reach, [&](int, const Vec2& axis) {
    const Vec2 from = center - axis;
    const double nearest = along2 > 0 ? -from.dot(along) / along2 : 0.0;
    const double offset = std::clamp(nearest, species.bead_offset.front(), species.bead_offset.back());
    const double gap = (from + offset * along).norm() - posts.radius() - species.max_radius - margin;
    if (gap > fastest * time) return;
    for (int b = 0; b < species.n_beads(); ++b) {
      const double s = species.bead_offset[b];
      const BeadByPost bead{from + s * along, velocity + s * turning,
                            0.5 * (std::abs(s) * flight.rate * flight.rate + pull)};
      time = time_to_post(bead, posts.radius() + species.bead_radius[b] + margin, time);
    }
  });
  return time;
}

}  // namespace shaken
