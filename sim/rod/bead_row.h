#pragma once

#include <algorithm>
#include <vector>

namespace shaken {

/// The beads of one species, from tail to head, equally spaced.
struct BeadRow {
  std::vector<double> offset;  ///< (n_beads) of the centres along the rod, from the rod's centre [mm]
  std::vector<double> radius;  ///< (n_beads) [mm]

  /// A sphere has none: no director, no order and no defects.
  bool has_axis() const { return offset.size() > 1; }
  /// Whether one end differs from the other: else a rod has no head, and its director no sign.
  bool is_polar() const { return !std::equal(radius.begin(), radius.end(), radius.rbegin()); }
  /// Where the rod ends, from its centre; the tail is at a negative place [mm].
  double tail() const;
  double head() const;
  /// Tip to tip [mm].
  double length() const { return head() - tail(); }
  /// The farthest that any bead reaches from the centre; half of the length, if the rod is the same fore and aft [mm].
  double reach() const;
  /// Covered by the union of the beads' discs, the axis being in the plane; exact to rounding [mm^2].
  double area() const;

  friend bool operator==(const BeadRow&, const BeadRow&) = default;
};

}  // namespace shaken
