#pragma once

#include <optional>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/system.h"

namespace shaken::analysis {

/// The part of the plane that rods can be in: all of a periodic box, or the arena within side walls in its
/// middle. What is measured between places is measured within it: not across a border of the box where walls stand
/// before it, and not through an annulus' inner wall.
class Region {
 public:
  /// A periodic box, or the arena that `walls` leave of it. Not explicit: a box is a region.
  Region(const Box& box, const std::optional<SideWalls>& walls = std::nullopt);
  /// The region of a square box.
  Region(double side) : Region(Box(side)) {}

  const Box& box() const { return box_; }
  bool has_walls() const { return walls_.has_value(); }
  /// After what it repeats itself along x and along y [mm]; 0 where walls end it.
  Vec2 period() const { return period_of(box_, walls_); }
  double area() const { return walls_ ? walls_->area(box_) : box_.area(); }  ///< [mm^2]
  /// Whether a place in the box lies within the walls.
  bool contains(const Vec2& place) const;
  /// From one place to another the shortest way: to the nearest image, or plainly where walls leave none.
  Vec2 shortest(const Vec2& difference) const;
  /// Half the diameter of the inner wall, which hides what lies behind it; 0 if there is none [mm].
  double hidden_radius() const { return walls_ && walls_->arena == Arena::kAnnulus ? walls_->inner / 2 : 0.0; }
  /// Whether the straight line between two places of the region stays in it: but for an annulus it always does.
  bool in_sight(const Vec2& a, const Vec2& b) const;

  /// Area of what lies at most `radius` from `place` and within its sight, so that the straight line to it stays in the
  /// region [mm^2]; exact. pi radius^2 of a periodic box. `radius` must be at most half a side along which it is
  /// periodic.
  double area_in_sight(const Vec2& place, double radius) const;

 private:
  Box box_;
  std::optional<SideWalls> walls_;
};

}  // namespace shaken::analysis
