#pragma once

#include <algorithm>

#include "base/core/types.h"

namespace shaken {

/// The box that rods are in: a rectangle with corners at 0 and (x, y), periodic along both [mm].
class Box {
 public:
  Box() = default;
  /// Not explicit: a number is the side of a square.
  Box(double side) : sides_(side, side) {}
  Box(double x, double y) : sides_(x, y) {}
  /// A box of side `side` along x, and `aspect` times as much along y.
  static Box of_aspect(double side, double aspect) { return {side, side * aspect}; }

  double x() const { return sides_.x(); }
  double y() const { return sides_.y(); }
  double operator[](Eigen::Index axis) const { return sides_[axis]; }
  const Vec2& sides() const { return sides_; }
  double shorter() const { return std::min(sides_.x(), sides_.y()); }
  double longer() const { return std::max(sides_.x(), sides_.y()); }
  double area() const { return sides_.x() * sides_.y(); }  ///< [mm^2]

  friend bool operator==(const Box&, const Box&) = default;

 private:
  Vec2 sides_ = Vec2::Zero();
};

}  // namespace shaken
