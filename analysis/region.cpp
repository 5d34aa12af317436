// SPDX-License-Identifier: MIT
#include "analysis/region.h"

#include <algorithm>
#include <cmath>

#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Of a disc of radius r about one corner of a rectangle, the area inside of the rectangle.
double quarter_in_rectangle(double width, double height, double r) {
  if (r * r >= width * width + height * height) return width * height;
  const double right = std::min(width, r);
  const double flat = height < r ? std::min(right, std::sqrt(r * r - height * height)) : 0.0;  // under the upper side
  const auto below_arc = [r](double x) {
    return 0.5 * (x * std::sqrt(std::max(0.0, r * r - x * x)) + r * r * std::asin(std::min(1.0, x / r)));
  };
  return height * flat + below_arc(right) - below_arc(flat);
}

double in_square(double half, const Vec2& place, double r) {
  double area = 0;
  for (const double width : {half - place.x(), half + place.x()}) {
    for (const double height : {half - place.y(), half + place.y()}) {
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

}  // namespace

Region::Region(const Box& box, const std::optional<SideWalls>& walls) : box_(box), walls_(walls) {
  SHAKEN_CHECK(box.shorter() > 0, "a region has room");
}

bool Region::contains(const Vec2& place) const {
  if (!walls_) return true;
  const Vec2 from_centre = (place - box_.sides() / 2).cwiseAbs();
  if (walls_->arena == Arena::kSquare) return from_centre.maxCoeff() <= walls_->size / 2;
  const double distance = from_centre.norm();
  return distance <= walls_->size / 2 && distance >= hidden_radius();
}

Vec2 Region::shortest(const Vec2& difference) const {
  if (walls_) return difference;
  return {std::remainder(difference.x(), box_.x()), std::remainder(difference.y(), box_.y())};
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
  if (walls_->arena == Arena::kSquare) return in_square(walls_->size / 2, from_centre, radius);
  return in_ring(hidden_radius(), walls_->size / 2, from_centre.norm(), radius);
}

}  // namespace shaken::analysis
