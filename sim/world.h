#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "sim/cell.h"
#include "sim/ledger.h"
#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/rod/species.h"
#include "sim/snapshot.h"
#include "sim/system.h"

namespace shaken {

/// Work done and extremes met since tick 0; part of the checkpoint.
struct Counters {
  std::int64_t impulses_rod_rod = 0;
  std::int64_t impulses_rod_base = 0;
  std::int64_t impulses_rod_lid = 0;
  std::int64_t impulses_rod_wall = 0;
  std::int64_t impulses_rod_post = 0;
  std::int64_t noise_kicks = 0;
  std::int64_t impacts_at_instant = 0;  ///< impulses given at their own instant within a tick
  double max_overlap_rod_rod = 0;       ///< deepest bead-bead overlap seen at a contact [mm]
  double max_overlap_rod_surface = 0;   ///< deepest overlap of a bead with plate, wall or post seen at a contact [mm]
  Ledger ledger;

  /// All numbers but the ledger's, in the order of checkpoints, where those of a scene with posts have the last.
  static constexpr auto fields() {
    using C = Counters;
    return std::tuple(&C::impulses_rod_rod, &C::impulses_rod_base, &C::impulses_rod_lid, &C::max_overlap_rod_rod,
                      &C::max_overlap_rod_surface, &C::impulses_rod_wall, &C::noise_kicks, &C::impacts_at_instant,
                      &C::impulses_rod_post);
  }
  /// Counts are added; of extremes the larger stays.
  void add(const Counters& more) {
    const auto join = [](auto& mine, auto its) {
      if constexpr (std::is_integral_v<decltype(its)>) {
        mine += its;
      } else {
        mine = std::max(mine, its);
      }
    };
    std::apply([&](auto... field) { (join(this->*field, more.*field), ...); }, fields());
    ledger.add(more.ledger);
  }
  double max_overlap() const { return std::max(max_overlap_rod_rod, max_overlap_rod_surface); }
};

/// Why a run had to end: never repaired, always reported.
struct NumericalTrouble {
  Tick tick = 0;
  std::vector<int> rods;  ///< the rods concerned
  std::string what;       ///< in words, with the values met
};

/// All mutable data of a simulation. What can be derived from it (neighbour lists, schedules) belongs to the stepper.
struct World {
  System system;
  std::vector<Species> species;                ///< (n_shapes) each size of each species, ready for use
  std::vector<std::uint8_t> species_of_shape;  ///< (n_shapes) 0 for the scene's rods, 1 and 2 for others that it has
  std::vector<std::uint8_t> shape_of_rod;      ///< (n_rods) index into both
  PlateMotion plates;
  Tick tick = 0;
  std::vector<Flight> rods;  ///< (n_rods)
  Counters counters;
  Content start;  ///< energy and momentum at tick 0

  const Species& species_of(std::size_t i) const { return species[shape_of_rod[i]]; }
  Cell cell() const;
};

/// The scene's species and plates at tick 0, without rods. Which rods are of which shape is drawn from the seed.
World empty_world(const System& system);

struct PoseAndMotion {
  Pose pose;  ///< where the rod would be if the box had not been left since its flight began
  Motion motion;
};
/// Pose and motion of rod `i` at `tick`, at which it flies already.
PoseAndMotion rod_at(const World& world, std::size_t i, Tick tick);

/// Every rod evaluated at the world's tick.
Snapshot snapshot(const World& world);

}  // namespace shaken
