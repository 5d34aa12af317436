// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim/core/heap_bytes.h"
#include "sim/core/types.h"
#include "sim/motion/flight.h"
#include "sim/rod/species.h"

namespace shaken {

/// The vector from `from` to the nearest periodic image of `to`; periodic in x and y only.
inline Vec3 nearest_image(const Vec3& from, const Vec3& to, double box_side) {
  Vec3 d = to - from;
  d.x() -= box_side * std::nearbyint(d.x() / box_side);
  d.y() -= box_side * std::nearbyint(d.y() / box_side);
  return d;
}

/// Pairs of rods that may touch before the list is due again. It looks at the rods' shadows on the plane only: shadows
/// apart means rods apart, and shadows move slowly, while the tips rock up and down every few milliseconds.
///
/// A rod's shadow lies in the stadium of radius max_radius round the segment of half-length h along its in-plane
/// angle (h as if it lay flat). The list holds every pair of stadiums closer than `skin`; it stays complete until some
/// segment's end has moved by half of that.
class NeighborList {
 public:
  NeighborList(const Species& species, double box_side, double skin);

  /// True if the list may be incomplete for these poses (or was never built).
  bool is_due(std::span<const Pose> poses) const;
  void build(std::span<const Pose> poses);
  /// How much further the ends of rod i's segment may move before the list may be incomplete; negative: it may be [mm].
  double slack(int i, const Pose& pose) const;
  /// (i, j) with i < j, in ascending order.
  std::span<const std::pair<int, int>> pairs() const { return pairs_; }
  /// Times built.
  std::int64_t n_builds() const { return n_builds_; }
  /// Heap memory held.
  std::size_t bytes() const { return heap_bytes(built_center_, built_half_, pairs_); }

 private:
  Vec2 flat_half(const Pose& pose) const;  ///< from the centre to the end of the flattened segment

  double half_length_;
  double reach_;  ///< centre lines closer than this make a pair [mm]
  double skin_;
  double box_side_;
  std::vector<Vec2> built_center_;
  std::vector<Vec2> built_half_;
  std::vector<std::pair<int, int>> pairs_;
  std::int64_t n_builds_ = 0;
};

}  // namespace shaken
