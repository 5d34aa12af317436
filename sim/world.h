// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/core/result.h"
#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/rod/species.h"
#include "sim/scene.h"
#include "sim/snapshot.h"

namespace shaken {

/// Work done and extremes met since tick 0; part of the checkpoint.
struct Counters {
  std::int64_t impulses_rod_rod = 0;
  std::int64_t impulses_rod_base = 0;
  std::int64_t impulses_rod_lid = 0;
  double max_overlap_rod_rod = 0;    ///< deepest bead-bead overlap seen at a contact [mm]
  double max_overlap_rod_plate = 0;  ///< deepest bead-plate overlap seen at a contact [mm]

  void add(const Counters& more) {
    impulses_rod_rod += more.impulses_rod_rod;
    impulses_rod_base += more.impulses_rod_base;
    impulses_rod_lid += more.impulses_rod_lid;
    max_overlap_rod_rod = std::max(max_overlap_rod_rod, more.max_overlap_rod_rod);
    max_overlap_rod_plate = std::max(max_overlap_rod_plate, more.max_overlap_rod_plate);
  }
  double max_overlap() const { return std::max(max_overlap_rod_rod, max_overlap_rod_plate); }
};

/// Why a run had to end: never repaired, always reported.
struct NumericalTrouble {
  Tick tick = 0;
  std::vector<int> rods;  ///< the rods concerned
  std::string what;       ///< in words, with the values met
};

/// All mutable data of a simulation. What can be derived from it (neighbour lists, schedules) belongs to the stepper.
struct World {
  Scene scene;
  Species species;  ///< of every rod
  PlateMotion plates;
  Tick tick = 0;
  std::vector<Flight> rods;  ///< (n_rods)
  Counters counters;
};

/// The scene's species and plates at tick 0, without rods.
World empty_world(const Scene& scene);

/// Places the rods as the scene says (initial.h). Fails if they cannot be packed.
Result<World> make_world(const Scene& scene);

/// Every rod evaluated at the world's tick.
Snapshot snapshot(const World& world);

/// Translation and rotation of all rods at the world's tick [pJ].
struct KineticEnergy {
  double translation_xy = 0;
  double translation_z = 0;
  double rotation = 0;
  double total() const { return translation_xy + translation_z + rotation; }
};
KineticEnergy kinetic_energy(const World& world);

/// XXH3 (64 bit) of tick and stored rod states.
std::uint64_t state_hash(const World& world);

}  // namespace shaken
