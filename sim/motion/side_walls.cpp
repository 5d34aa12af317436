#include "sim/motion/side_walls.h"

#include <algorithm>
#include <cmath>

#include "sim/motion/ellipse.h"

namespace shaken {
namespace {

/// More than rounding moves a bead or a wall [mm].
double margin_for_rounding(const Box& box) { return 1e-9 * (1.0 + box.longer()); }

/// A rod's axis in the plane, as seen from the middle of the arena.
struct Axis {
  Vec2 center;  ///< of the rod
  Vec2 along;   ///< the director's part in the plane

  Axis(const Box& box, const Pose& pose)
      : center(pose.position.x() - 0.5 * box.x(), pose.position.y() - 0.5 * box.y()),
        along(pose.director.x(), pose.director.y()) {}
  Vec2 at(double offset) const { return center + offset * along; }
  /// Squared distance of its nearest point to the middle, from the first bead to the last.
  double nearest_squared(const Species& species) const {
    const double along2 = along.squaredNorm();
    const double nearest = along2 > 0 ? -center.dot(along) / along2 : 0.0;
    return at(std::clamp(nearest, species.bead_offset.front(), species.bead_offset.back())).squaredNorm();
  }
};

/// The way to a point, seen from the middle of a stadium, from the nearest point of the line between the centres
/// of the round ends.
Vec2 from_centre_line(const SideWalls& walls, const Vec2& point) {
  const double end = 0.5 * walls.length;
  return {point.x() - std::clamp(point.x(), -end, end), point.y()};
}

Ellipse ellipse_of(const SideWalls& walls) { return {0.5 * walls.length, 0.5 * walls.size}; }

/// A straight wall; what is said of points is as seen from the middle of the arena.
struct StraightWall {
  Vec2 normal;    ///< into the arena
  double offset;  ///< distance of the middle
  double distance(const Vec2& point) const { return offset + normal.dot(point); }
};

/// The walls of a wedge: its wide end, its narrow end, which may be a corner, and those that slant, above and below.
std::array<StraightWall, 4> walls_of_wedge(const SideWalls& walls) {
  const double slope = 0.5 * (walls.size - walls.narrow) / walls.length;
  const double along = 1.0 / std::sqrt(1.0 + slope * slope);
  const double end = 0.5 * walls.length, middle = 0.25 * (walls.size + walls.narrow) * along;
  return {StraightWall{Vec2(1, 0), end}, StraightWall{Vec2(-1, 0), end},
          StraightWall{Vec2(-slope * along, -along), middle}, StraightWall{Vec2(-slope * along, along), middle}};
}

/// Where a bead goes in the plane: at time t it is within bend t^2 of point + velocity t.
struct BeadPath {
  Vec2 point;
  Vec2 velocity;
  double bend;
};

/// The first time t > 0 with a t^2 + 2 b t = c, where a >= 0 and c > 0; at most `time`. Numerics: of the root's two
/// forms, that in which nothing cancels.
double first_time(double a, double b, double c, double time) {
  if (!((a * time + 2.0 * b) * time > c)) return time;
  const double root = std::sqrt(b * b + a * c);
  return b > 0 ? c / (b + root) : (root - b) / a;
}

/// The first time that a bead may reach a straight wall, `gap` away, that it nears at `speed`; at most `time`.
double time_to_straight_wall(double gap, double speed, double bend, double time) {
  return gap > 0 ? first_time(bend, 0.5 * speed, gap, time) : 0.0;
}

/// The same for the two walls across one axis, x or y, each `half` away from the middle.
double time_to_two_walls(const BeadPath& path, int axis, double half, double time) {
  time = time_to_straight_wall(half - path.point[axis], path.velocity[axis], path.bend, time);
  return time_to_straight_wall(half + path.point[axis], -path.velocity[axis], path.bend, time);
}

/// The first time that a bead within a circle of the given radius round the middle may reach it; at most `time`.
double time_to_round_wall(const BeadPath& path, double radius, double time) {
  const double room = radius * radius - path.point.squaredNorm();
  if (!(radius > 0 && room > 0)) return 0.0;
  const double speed2 = path.velocity.squaredNorm() + 2.0 * radius * path.bend;
  return first_time(speed2, path.point.dot(path.velocity), room, time);
}

/// The same for the round end of a stadium that lies in the direction `way` along x, 1 or -1, with its centre `end`
/// away from the middle: the bead does not meet it before it leaves the part between the straight walls, nor before it
/// meets the circle.
double time_to_round_end(const BeadPath& path, double way, double end, double radius, double time) {
  const double to_end = time_to_straight_wall(end - way * path.point.x(), way * path.velocity.x(), path.bend, time);
  const BeadPath from_end{path.point - Vec2(way * end, 0), path.velocity, path.bend};
  return std::max(to_end, time_to_round_wall(from_end, radius, time));
}

/// The first time that a bead of the given reach may touch an ellipse; at most `time`.
double time_to_ellipse(const Ellipse& ellipse, const BeadPath& path, double reach, double time) {
  Ellipse::Disc disc = ellipse.disc_round(path.point);
  if (!(disc.depth(path.point) > reach))
    disc = ellipse.disc_at(std::copysign(ellipse.nearest(path.point), path.point.x()));
  return time_to_round_wall({path.point - Vec2(disc.centre, 0), path.velocity, path.bend}, disc.radius - reach, time);
}

/// The first time that a bead may come as near to an outer wall as it reaches; at most `time`.
double time_to_outer_wall(const SideWalls& walls, const BeadPath& path, double reach, double time) {
  const double radius = 0.5 * walls.size - reach;  // in which it is free, round the middle or middle line
  switch (walls.arena) {
    case Arena::kSquare:
      return time_to_two_walls(path, 1, radius, time_to_two_walls(path, 0, radius, time));
    case Arena::kChannel:
      return time_to_two_walls(path, 1, radius, time);
    case Arena::kStadium:
      time = time_to_two_walls(path, 1, radius, time);
      time = time_to_round_end(path, 1.0, 0.5 * walls.length, radius, time);
      return time_to_round_end(path, -1.0, 0.5 * walls.length, radius, time);
    case Arena::kEllipse:
      return time_to_ellipse(ellipse_of(walls), path, reach, time);
    case Arena::kWedge:
      for (const StraightWall& wall : walls_of_wedge(walls)) {
        const double speed = -wall.normal.dot(path.velocity);
        time = time_to_straight_wall(wall.distance(path.point) - reach, speed, path.bend, time);
      }
      return time;
    case Arena::kDisc:
    case Arena::kAnnulus:
      break;
  }
  return time_to_round_wall(path, radius, time);
}

/// Whether a point, as seen from the middle, is further from all outer walls than `reach`.
bool is_clear_of_outer_wall(const SideWalls& walls, const Vec2& point, double reach) {
  const double most = 0.5 * walls.size - reach;
  if (walls.arena == Arena::kSquare) return std::max(std::abs(point.x()), std::abs(point.y())) < most;
  if (walls.arena == Arena::kChannel) return std::abs(point.y()) < most;
  if (walls.arena == Arena::kEllipse) {
    const Ellipse ellipse = ellipse_of(walls);
    return ellipse.disc_round(point).depth(point) > reach || ellipse.see(point).distance > reach;
  }
  if (walls.arena == Arena::kWedge) {
    return std::ranges::all_of(walls_of_wedge(walls), [&](const auto& wall) { return wall.distance(point) > reach; });
  }
  const Vec2 off = walls.arena == Arena::kStadium ? from_centre_line(walls, point) : point;
  return most > 0 && off.squaredNorm() < most * most;
}

/// The first time that a bead outside of such a circle may reach it; at most `time`.
double time_to_inner_wall(const BeadPath& path, double radius, double time) {
  const double distance = path.point.norm();
  return time_to_straight_wall(distance - radius, -path.point.dot(path.velocity) / distance, path.bend, time);
}

}  // namespace

WallsSeen see_walls(const SideWalls& walls, const Box& box, const Vec3& point, double reach) {
  const double x = point.x() - 0.5 * box.x();
  const double y = point.y() - 0.5 * box.y();
  const double half = 0.5 * walls.size;
  if (walls.arena == Arena::kSquare) {
    const Vec3 from_x(x > 0 ? -1.0 : 1.0, 0, 0);
    const Vec3 from_y(0, y > 0 ? -1.0 : 1.0, 0);
    return {{WallSeen{half - std::abs(x), from_x}, WallSeen{half - std::abs(y), from_y}}, 2};
  }
  if (walls.arena == Arena::kChannel) return {{WallSeen{half - std::abs(y), Vec3(0, y > 0 ? -1.0 : 1.0, 0)}}, 1};
  if (walls.arena == Arena::kEllipse) {
    const Ellipse ellipse = ellipse_of(walls);
    if (ellipse.disc_round({x, y}).depth({x, y}) > reach) return {};
    const auto [distance, normal] = ellipse.see({x, y});
    return {{WallSeen{distance, Vec3(normal.x(), normal.y(), 0)}}, 1};
  }
  if (walls.arena == Arena::kWedge) {
    const auto [wide, narrow, above, below] = walls_of_wedge(walls);
    const auto seen = [&](const StraightWall& wall) {
      return WallSeen{wall.distance({x, y}), Vec3(wall.normal.x(), wall.normal.y(), 0)};
    };
    return {{seen(x > 0 ? narrow : wide), seen(above), seen(below)}, 3};
  }
  const double along = walls.arena == Arena::kStadium ? from_centre_line(walls, {x, y}).x() : x;
  const double r = std::sqrt(along * along + y * y);
  const Vec3 inwards = r > 0 ? Vec3(-along / r, -y / r, 0) : Vec3(1, 0, 0);
  const WallSeen outer{half - r, inwards};
  if (walls.arena != Arena::kAnnulus) return {{outer}, 1};
  return {{outer, WallSeen{r - 0.5 * walls.inner, -inwards}}, 2};
}

double distance_to_walls(const SideWalls& walls, const Box& box, const Vec3& point, double reach) {
  const WallsSeen seen = see_walls(walls, box, point, reach);
  double least = INFINITY;
  for (int w = 0; w < seen.n; ++w) least = std::min(least, seen.walls[static_cast<std::size_t>(w)].distance);
  return least;
}

bool is_within(const SideWalls& walls, const Box& box, const Species& species, const Pose& pose) {
  for (int b = 0; b < species.n_beads(); ++b) {
    const Vec3 center = pose.position + species.bead_offset[b] * pose.director;
    if (distance_to_walls(walls, box, center, species.bead_radius[b]) < species.bead_radius[b]) return false;
  }
  return true;
}

bool may_touch_walls(const SideWalls& walls, const Box& box, const Species& species, const Pose& pose) {
  const Axis axis(box, pose);
  const double margin = margin_for_rounding(box);
  for (const int b : species.outer_beads) {
    if (!is_clear_of_outer_wall(walls, axis.at(species.bead_offset[b]), species.bead_radius[b] + margin)) return true;
  }
  if (walls.arena != Arena::kAnnulus) return false;
  const double least = 0.5 * walls.inner + species.max_radius + margin;
  return !(axis.nearest_squared(species) > least * least);
}

double wall_safe_time(const SideWalls& walls, const Box& box, const Species& species, const Pose& pose,
                      const Flight& flight, double horizon, double pull) {
  const double margin = margin_for_rounding(box);
  const Vec2 velocity(flight.velocity.x(), flight.velocity.y());
  const double fastest = velocity.norm() + pull * horizon + species.half_length * flight.rate;  // of its beads
  const Axis axis(box, pose);
  const double room = walls.arena == Arena::kEllipse ? ellipse_of(walls).disc_round(axis.center).depth(axis.center)
                                                     : distance_to_walls(walls, box, pose.position);
  if (room - species.half_length - species.max_radius - margin > fastest * horizon) return horizon;

  const Vec3 turning = flight.precession.cross(pose.director);
  const auto path_of = [&](int bead) {
    const double offset = species.bead_offset[bead];
    return BeadPath{axis.at(offset), velocity + offset * Vec2(turning.x(), turning.y()),
                    0.5 * (std::abs(offset) * flight.rate * flight.rate + pull)};
  };
  double time = horizon;
  for (const int b : species.outer_beads) {
    time = time_to_outer_wall(walls, path_of(b), species.bead_radius[b] + margin, time);
  }
  if (walls.arena != Arena::kAnnulus) return time;
  const double inner = 0.5 * walls.inner + margin;
  if (std::sqrt(axis.nearest_squared(species)) - inner - species.max_radius > fastest * time) return time;
  for (int b = 0; b < species.n_beads(); ++b)
    time = time_to_inner_wall(path_of(b), inner + species.bead_radius[b], time);
  return time;
}

}  // namespace shaken
