#include "analysis/geometry/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/core/check.h"
#include "sim/motion/side_walls.h"

namespace shaken::analysis {
namespace {

/// The area that a disc of radius r about a corner of a rectangle has inside of the rectangle.
double quarter_in_rectangle(double width, double height, double r) {
  if (r * r >= width * width + height * height) return width * height;
  const double right = std::min(width, r);
  const double flat = height < r ? std::min(right, std::sqrt(r * r - height * height)) : 0.0;  // under the upper side
  const auto below_arc = [r](double x) {
    return 0.5 * (x * std::sqrt(std::max(0.0, r * r - x * x)) + r * r * std::asin(std::min(1.0, x / r)));
  };
  return height * flat + below_arc(right) - below_arc(flat);
}

/// The area of a disc about `place` in a rectangle round the centre, whose half sides are `half`; they may be infinite.
double in_rectangle(const Vec2& half, const Vec2& place, double r) {
  double area = 0;
  for (const double width : {half.x() - place.x(), half.x() + place.x()}) {
    for (const double height : {half.y() - place.y(), half.y() + place.y()}) {
      if (width > 0 && height > 0) area += quarter_in_rectangle(width, height, r);
    }
  }
  return area;
}

/// In sight from a place at `distance` from the centre of a ring, at most r away: half of it, on one side of the line
/// to the centre, in polar coordinates about the place, with angles phi from that line. Below `cone` one looks at the
/// inner wall, above at the outer one. What a ray sweeps up to a wall of radius R is the difference between a sector
/// about the ring's centre, of angle beta, and a triangle.
double in_ring(double inner, double outer, double distance, double r) {
  distance = std::clamp(distance, inner, outer);
  const double cone = inner > 0 ? std::asin(std::min(1.0, inner / distance)) : 0.0;
  /// Angle at which a circle of radius r about the place meets the wall.
  const auto meets = [&](double wall) {
    return std::acos(std::clamp((r * r + distance * distance - wall * wall) / (2 * r * distance), -1.0, 1.0));
  };
  /// Between sector and triangle, of a ray that ends on the wall after `way`.
  const auto sector_less_triangle = [&](double wall, double phi, double way) {
    const double beta = std::atan2(way * std::sin(phi), distance - way * std::cos(phi));
    return 0.5 * wall * (wall * beta - distance * std::sin(beta));
  };

  // From `clear` on the outer wall is nearer than r.
  const double clear = r <= outer - distance ? kPi : r >= outer + distance ? 0.0 : meets(outer);
  double half = 0.5 * r * r * std::max(0.0, clear - cone);
  if (const double from = std::max(clear, cone); from < kPi) {
    const double across = distance * std::sin(from);
    const double way = distance * std::cos(from) + std::sqrt(std::max(0.0, outer * outer - across * across));
    half += sector_less_triangle(outer, from, way);
  }
  if (inner <= 0) return 2 * half;
  // Up to `blocked` the inner wall is nearer than r.
  const double tangent = std::sqrt(std::max(0.0, distance * distance - inner * inner));
  const double blocked = r <= distance - inner ? 0.0 : r >= tangent ? cone : std::min(cone, meets(inner));
  half += 0.5 * r * r * (cone - blocked);
  if (blocked > 0) {
    const double across = distance * std::sin(blocked);
    const double way = distance * std::cos(blocked) - std::sqrt(std::max(0.0, inner * inner - across * across));
    half -= sector_less_triangle(inner, blocked, way);
  }
  return 2 * half;
}

/// Where f, of which f(low) and f(high) differ in sign, is 0: by false position, where an end that stays counts half
/// (the Illinois method; Dowell & Jarratt, BIT 11, 168, 1971). It ends with a step below `precision`.
template <class Function>
double root_of(const Function& f, double low, double high, double precision) {
  double at_low = f(low), at_high = f(high);
  double root = high;
  for (int step = 0; step < 60 && at_high != 0; ++step) {
    const double next = (low * at_high - high * at_low) / (at_high - at_low);
    const double at_next = f(next);
    const bool is_done = std::abs(next - root) < precision;
    root = next;
    if (is_done || at_next == 0) break;
    if ((at_next > 0) == (at_high > 0)) {
      at_low *= 0.5;
    } else {
      low = high;
      at_low = at_high;
    }
    high = next;
    at_high = at_next;
  }
  return root;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// What a place at the origin has within a convex border that is given piece by piece, counter-clockwise, and within a
/// circle of radius r about it: sectors of that circle where the border is not nearer.
class InConvex {
 public:
  explicit InConvex(double r) : r_(r) {}

  void add_line(const Vec2& from, const Vec2& to) {
    // the part of it within the circle
    const Vec2 way = to - from;
    const double a = way.squaredNorm(), b = from.dot(way), root2 = b * b - a * (from.squaredNorm() - r_ * r_);
    if (!(a > 0 && root2 > 0)) return;
    const double begin = std::max(0.0, (-b - std::sqrt(root2)) / a), end = std::min(1.0, (-b + std::sqrt(root2)) / a);
    if (begin < end) add_piece(from + begin * way, from + end * way, 0.0);
  }

  /// Half a circle of radius `radius` about `centre`, from the angle `first` on.
  void add_half_circle(const Vec2& centre, double radius, double first) {
    // within the other circle are the angles further than `apart` from that of the centre
    const double distance = centre.norm();
    double apart = radius <= r_ ? 0.0 : kPi;
    if (distance > 0) {
      const double cosine = (r_ * r_ - distance * distance - radius * radius) / (2 * distance * radius);
      apart = std::acos(std::clamp(cosine, -1.0, 1.0));
    }
    const double outwards = std::atan2(centre.y(), centre.x());
    for (int turn = -2; turn <= 2; ++turn) {
      const double begin = std::max(first, outwards + 2 * kPi * turn + apart);
      const double end = std::min(first + kPi, outwards + 2 * kPi * (turn + 1) - apart);
      const auto point = [&](double angle) { return Vec2(centre + radius * Vec2(std::cos(angle), std::sin(angle))); };
      if (begin < end) add_piece(point(begin), point(end), radius * radius * (end - begin - std::sin(end - begin)));
    }
  }

  /// All of an ellipse with half axes a and b, a >= b, along x and y; `place`, above 0 in both, is that of the origin
  /// from its centre.
  void add_ellipse(const Vec2& place, double a, double b) {
    const auto point = [&](double angle) { return Vec2(Vec2(a * std::cos(angle), b * std::sin(angle)) - place); };
    const auto beyond = [&](double angle) { return point(angle).squaredNorm() - r_ * r_; };
    const auto rises = [&](double angle) {  // how fast that does, halved
      const double c = std::cos(angle), s = std::sin(angle);
      return (b * b - a * a) * s * c + a * place.x() * s - b * place.y() * c;
    };
    // In each quarter the distance has one extremum at most, but for the last: there `rises` over sine and cosine is
    // convex, least at `between`, and has no zero or one on either side.
    const double between = 2 * kPi - std::atan(std::cbrt(b * place.y() / (a * place.x())));
    const std::array ends{kPi / 2, kPi, 1.5 * kPi, between, 2 * kPi};
    double last = 0;
    bool was_within = beyond(last) <= 0;
    const auto add_up_to = [&](double angle) {  // monotonic from the last one on
      const bool is_within = beyond(angle) <= 0;
      const double crossing = is_within == was_within ? angle : root_of(beyond, last, angle, 1e-13);
      const double begin = was_within ? last : crossing, end = is_within ? angle : crossing;
      if ((was_within || is_within) && begin < end)
        add_piece(point(begin), point(end), a * b * (end - begin - std::sin(end - begin)));
      last = angle;
      was_within = is_within;
    };
    double before = rises(0);
    for (const double end : ends) {
      const double after = rises(end);
      // so near to an extremum two crossings cut off next to nothing
      if (before * after < 0) add_up_to(root_of(rises, last, end, 1e-6));
      add_up_to(end);
      before = after;
    }
  }

  double area() const { return 0.5 * (twice_ + r_ * r_ * std::max(0.0, angle_)); }

 private:
  /// `bulge`: twice the area between the piece and the straight line.
  void add_piece(const Vec2& from, const Vec2& to, double bulge) {
    const double turned = cross(from, to), along = from.dot(to);
    twice_ += turned + bulge;
    // seen from within it goes round forwards; by more than half a turn only where its ends are not on one side
    angle_ -= turned < 0 && along > 0 ? 0.0 : std::atan2(turned, along) + (turned < 0 ? 2 * kPi : 0.0);
  }

  double r_;
  double twice_ = 0;
  double angle_ = 2 * kPi;  ///< in which the border is not nearer than r
};

/// Within a stadium, whose round ends are `end` from the centre, of a place that is not outside of it.
double in_stadium(double end, double radius, const Vec2& place, double r) {
  InConvex sum(r);
  sum.add_half_circle(Vec2(end, 0) - place, radius, -kPi / 2);
  sum.add_line(Vec2(end, radius) - place, Vec2(-end, radius) - place);
  sum.add_half_circle(Vec2(-end, 0) - place, radius, kPi / 2);
  sum.add_line(Vec2(-end, -radius) - place, Vec2(end, -radius) - place);
  return sum.area();
}

/// Within an ellipse of such half axes, of a place that is not outside of it.
double in_ellipse(double a, double b, const Vec2& place, double r) {
  InConvex sum(r);
  sum.add_ellipse(place.cwiseAbs().cwiseMax(1e-12 * b), a, b);
  return sum.area();
}

/// Within a wedge, of a place that is not outside of it.
double in_wedge(const SideWalls& walls, const Vec2& place, double r) {
  const double end = walls.length / 2, wide = walls.size / 2, narrow = walls.narrow / 2;
  const std::array corners{Vec2(-end, -wide), Vec2(end, -narrow), Vec2(end, narrow), Vec2(-end, wide)};
  const Vec2 within = (1 - 1e-13) * place;  // not in a corner, round which the border would not go
  InConvex sum(r);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    sum.add_line(corners[k] - within, corners[(k + 1) % corners.size()] - within);
  }
  return sum.area();
}

}  // namespace

Region::Region(const Box& box, const std::optional<SideWalls>& walls) : box_(box), walls_(walls) {
  SHAKEN_CHECK(box.shorter() > 0, "a region has room");
}

bool Region::contains(const Vec2& place) const {
  return !walls_ || distance_to_walls(*walls_, box_, Vec3(place.x(), place.y(), 0)) >= 0;
}

Vec2 Region::shortest(const Vec2& difference) const {
  const Vec2 after = period();
  const auto folded = [](double way, double side) { return side > 0 ? std::remainder(way, side) : way; };
  return {folded(difference.x(), after.x()), folded(difference.y(), after.y())};
}

bool Region::in_sight(const Vec2& a, const Vec2& b) const {
  const double hidden = hidden_radius();
  if (hidden <= 0) return true;
  // The point of the line nearest to the centre.
  const Vec2 from = a - box_.sides() / 2, way = b - a;
  const double squared = way.squaredNorm();
  const double part = squared > 0 ? std::clamp(-from.dot(way) / squared, 0.0, 1.0) : 0.0;
  // Only strictly between its ends does a line cross a wall that both ends are on the right side of.
  return part <= 0 || part >= 1 || (from + part * way).squaredNorm() >= hidden * hidden;
}

double Region::area_in_sight(const Vec2& place, double radius) const {
  if (radius <= 0) return 0;
  if (!walls_) return kPi * radius * radius;
  const Vec2 from_centre = place - box_.sides() / 2;
  const double half = walls_->size / 2;
  switch (walls_->arena) {
    case Arena::kSquare:
      return in_rectangle(Vec2(half, half), from_centre, radius);
    case Arena::kChannel:
      return in_rectangle(Vec2(std::numeric_limits<double>::infinity(), half), Vec2(0, from_centre.y()), radius);
    case Arena::kStadium:
      return in_stadium(walls_->length / 2, half, from_centre, radius);
    case Arena::kEllipse:
      if (distance_to_walls(*walls_, box_, Vec3(place.x(), place.y(), 0)) >= radius) return kPi * radius * radius;
      return in_ellipse(walls_->length / 2, half, from_centre, radius);
    case Arena::kWedge:
      return in_wedge(*walls_, from_centre, radius);
    case Arena::kDisc:
    case Arena::kAnnulus:
      break;
  }
  return in_ring(hidden_radius(), half, from_centre.norm(), radius);
}

}  // namespace shaken::analysis
