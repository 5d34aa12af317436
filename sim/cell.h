// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/posts.h"
#include "sim/rod/bead_row.h"
#include "sim/system.h"

namespace shaken {

/// Where the rods of a run are, and of which species: what stays the same from frame to frame, and is needed to
/// draw or measure one. A System says how a scene wants it; this is what came of it, and what files and messages carry.
struct Cell {
  Box box;         ///< periodic where no walls stand
  double gap = 0;  ///< between the plates [mm]
  std::optional<SideWalls> walls{};
  StandingPosts posts{};                       ///< if any
  std::vector<BeadRow> species{};              ///< order, director and defects are of the first
  std::vector<std::uint8_t> species_of_rod{};  ///< (n_rods) from 0; empty if there is one species

  std::size_t species_of(std::size_t rod) const { return species_of_rod.empty() ? 0 : species_of_rod[rod]; }
  const BeadRow& beads_of(std::size_t rod) const { return species[species_of(rod)]; }
  /// Of `values`, which has one for each rod, those of the rods of species `k`.
  template <class Value>
  std::vector<Value> of_species(std::size_t k, const std::vector<Value>& values) const {
    if (species_of_rod.empty() && k == 0) return values;
    std::vector<Value> chosen;
    for (std::size_t rod = 0; rod < values.size(); ++rod) {
      if (species_of(rod) == k) chosen.push_back(values[rod]);
    }
    return chosen;
  }
  /// Whether the rods of the first species have axes: spheres have none, and no order, director or defects.
  bool has_axes() const { return !species.empty() && species.front().has_axis(); }
  /// What the rods have to share [mm^2].
  double area() const { return (walls ? walls->area(box) : box.area()) - posts.area(); }
  /// After what the plane repeats itself along x and along y [mm]; 0 where side walls end it.
  Vec2 period() const { return period_of(box, walls); }

  friend bool operator==(const Cell&, const Cell&) = default;
};

}  // namespace shaken
