#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/posts.h"
#include "sim/rod/bead_row.h"
#include "sim/system.h"

namespace shaken {

/// Where the rods of a run are, and of which shape: what stays the same from frame to frame, and is needed to
/// draw or measure one. A System says how a scene wants it; this is what came of it, and what files and messages carry.
struct Cell {
  Box box;         ///< periodic where no walls stand
  double gap = 0;  ///< between the plates [mm]
  std::optional<SideWalls> walls{};
  StandingPosts posts{};                         ///< if any
  std::vector<BeadRow> shapes{};                 ///< species by species, each with that of its mean rod in front
  std::vector<std::uint8_t> shape_of_rod{};      ///< (n_rods) from 0; empty if there is one shape
  std::vector<std::uint8_t> species_of_shape{};  ///< (n_shapes) from 0, ascending; empty if every species has one shape

  std::size_t shape_of(std::size_t rod) const { return shape_of_rod.empty() ? 0 : shape_of_rod[rod]; }
  const BeadRow& beads_of(std::size_t rod) const { return shapes[shape_of(rod)]; }
  std::size_t n_species() const { return species_of_shape.empty() ? shapes.size() : species_of_shape.back() + 1U; }
  bool has_one_species() const {
    return species_of_shape.empty() ? shape_of_rod.empty() : species_of_shape.back() == 0;
  }
  /// Order, director and defects are of the first.
  std::size_t species_of(std::size_t rod) const {
    return species_of_shape.empty() ? shape_of(rod) : species_of_shape[shape_of(rod)];
  }
  /// The beads of the mean rod of species `k`.
  const BeadRow& mean_of_species(std::size_t k) const { return shapes[first_shape_of(k)]; }
  /// (n_rods), where there are several shapes.
  std::vector<std::uint8_t> species_of_rods() const {
    if (species_of_shape.empty()) return shape_of_rod;
    std::vector<std::uint8_t> species;
    for (const std::uint8_t shape : shape_of_rod) species.push_back(species_of_shape[shape]);
    return species;
  }
  /// That of the mean rod of species `k`, which there must be.
  std::size_t first_shape_of(std::size_t k) const {
    if (species_of_shape.empty()) return k;
    return static_cast<std::size_t>(std::ranges::find(species_of_shape, k) - species_of_shape.begin());
  }
  /// Those of `values`, which has one for each rod, that are of rods of species `k`.
  template <class Value>
  std::vector<Value> of_species(std::size_t k, const std::vector<Value>& values) const {
    if (has_one_species() && k == 0) return values;
    std::vector<Value> chosen;
    for (std::size_t rod = 0; rod < values.size(); ++rod) {
      if (species_of(rod) == k) chosen.push_back(values[rod]);
    }
    return chosen;
  }
  /// Whether the rods of the first species have axes: spheres have none, and no order, director or defects.
  bool has_axes() const { return !shapes.empty() && shapes.front().has_axis(); }
  /// What the rods have to share [mm^2].
  double area() const { return (walls ? walls->area(box) : box.area()) - posts.area(); }
  /// After what the plane repeats itself along x and along y [mm]; 0 where side walls end it.
  Vec2 period() const { return period_of(box, walls); }

  friend bool operator==(const Cell&, const Cell&) = default;
};

}  // namespace shaken
