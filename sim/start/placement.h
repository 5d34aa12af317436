#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "base/core/rng.h"
#include "base/core/types.h"
#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/motion/post_grid.h"
#include "sim/rod/species.h"
#include "sim/system.h"

namespace shaken {

/// The direction at an angle to x [rad].
Vec2 unit_vector(double angle);

/// The rods that are to be placed in a box: how much room they need along x, which may stand in their way, and how they
/// begin to move. A mixture's lattice has room for any two of its species side by side.
class Placement {
 public:
  /// Least distance between rods of a lattice [mm].
  static constexpr double kClearance = 0.002;

  /// Keeps references to all three. shape_of_rod: (n_rods).
  Placement(const System& of_system, std::span<const Species> of_species, std::span<const std::uint8_t> of_kinds);

  int n_rods() const { return static_cast<int>(shape_of_rod.size()); }
  const Species& species_of(int i) const { return species[shape_of_rod[static_cast<std::size_t>(i)]]; }
  /// Whether its two ends differ.
  static bool is_polar(const Species& kind);

  /// From tip to tip of the longest, as if its longer half were on both sides [mm].
  double rod_extent() const;
  /// The radius of the thickest bead of all [mm].
  double max_radius() const;
  /// Least distance of two rows of rods of any species, with a rod every `pitch`, shifted against each other by `shift`
  /// [mm].
  double least_row_distance(double pitch, double shift) const;
  /// By how much any rod is shorter in the plane, on either side, for being tilted [mm].
  double shortened_by_tilt() const;

  /// Whether something stands in the box, so that not every place of it is free.
  bool has_uprights() const { return system.walls || posts_; }
  bool has_posts() const { return posts_.has_value(); }
  /// A rod of this kind touches neither walls nor posts.
  bool is_clear(const Species& kind, const Pose& pose) const;

  /// Gives a rod, whose place in the plane is set, a height and a tilt that keep it off both plates, and a random
  /// motion. in_plane: its direction, a unit vector; flat: without tilt.
  void lift_and_push(Flight& flight, const Species& kind, const Vec2& in_plane, bool flat, Rng& rng) const;

  /// So many of the rods in words: "300 rods (area fraction 0.675)".
  std::string amount(int count) const;
  Error does_not_fit(const std::string& why) const;

  const System& system;
  const PlatesAtStart plates;  ///< at tick 0, between which the rods are placed
  const std::span<const Species> species;
  const std::span<const std::uint8_t> shape_of_rod;

 private:
  struct Beads {
    std::vector<double> offset, radius;
  };
  static double least_distance2(const Beads& one, const Beads& other, double pitch, double shift);
  double most_tilt(const Species& kind) const;

  std::vector<Beads> poses_;       ///< of each species, either way round if the ends differ
  std::optional<PostGrid> posts_;  ///< thicker, by as much as a bead comes nearer when its rod is tilted
};

}  // namespace shaken
