#pragma once

#include <optional>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/system.h"

namespace shaken {

/// Posts where they stand.
struct StandingPosts {
  double diameter = 0;          ///< [mm]
  std::vector<Vec2> centres{};  ///< (n_posts) of their axes, in the box [mm]

  /// That they take of the plane [mm^2].
  double area() const;
  friend bool operator==(const StandingPosts&, const StandingPosts&) = default;
};

/// Those of a scene: at the given places, or else at the sites of a lattice, which are `columns` by `rows` equal parts
/// of the box, or of the rectangle round the arena, with one post in the middle of each. A site at which a post would
/// not stand wholly within the walls stays empty; one that touches them does.
StandingPosts standing_posts(const Posts& posts, const Box& box, const std::optional<SideWalls>& walls);
/// Those of a system; none if it has none.
StandingPosts standing_posts(const System& system);

/// The rectangle round what rods may be in: the box, or that round the arena in its middle [mm].
Vec2 rectangle_round(const Box& box, const std::optional<SideWalls>& walls);

/// Whether a post at this place stands within the walls, or touches them.
bool stands_within(const Vec2& centre, double diameter, const Box& box, const std::optional<SideWalls>& walls);

}  // namespace shaken
