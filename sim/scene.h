// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sim/core/types.h"

namespace shaken {

/// The shape of one kind of rod: equally spaced beads on a line, whose radius falls linearly from the centre bead to
/// the two ends (Sharma & Soni 2024, section 2).
struct RodShape {
  double length = 4.5;        ///< tip to tip [mm]
  double mid_diameter = 0.8;  ///< of the centre bead [mm]
  double end_diameter = 0.4;  ///< of the two end beads [mm]
  int n_beads = 15;           ///< odd; 1 is a sphere of diameter `mid_diameter`
  double density = 8.5;       ///< [mg/mm^3]; brass. Sets the unit of energy only: equal rods move alike at any density
  friend bool operator==(const RodShape&, const RodShape&) = default;
};

/// Restitution and Coulomb's friction of one kind of contact; what restitution is of, the impulse law says.
struct ContactParameters {
  double friction = 0.0;     ///< mu >= 0
  double restitution = 1.0;  ///< e in [0, 1]
  friend bool operator==(const ContactParameters&, const ContactParameters&) = default;
};

/// What becomes of the relative velocity at a contact (sim/contact/impulse_law.h).
enum class ImpulseLaw {
  kNewton,     ///< restitution of the normal velocity
  kPoisson,    ///< of the normal impulse
  kEnergetic,  ///< of the normal impulse's work; never makes energy
};
/// How the run is stepped; the trajectory is bitwise the same.
enum class Engine {
  kReference,  ///< visits every rod and pair at every tick
  kScheduled,  ///< visits them only when contact is possible
};
enum class Start {
  kAligned,  ///< rods along x in rows, every other row shifted by half a rod
  kRandom,   ///< random places and directions, one after the other (dilute systems)
};

/// The physical system and how it is stepped: all that `make_world` needs. What to measure, record and draw is not
/// the simulation's business and lives in scene/run_plan.h. The defaults are the paper's (Sharma & Soni 2024).
struct Scene {
  RodShape rod;
  int n_rods = 2109;        ///< number of rods
  double box_side = 83.73;  ///< L, of the square box, periodic in x and y [mm]
  double gap = 1.2;         ///< w, between base and lid [mm]

  double amplitude = 0.043486;  ///< a, of the plates' vibration [mm]; Gamma = a (2 pi f)^2 / g
  double frequency = 200.0;     ///< f, of the plates' vibration [Hz]
  double gravity = 9810.0;      ///< g, downwards [mm/s^2]

  ContactParameters rod_rod{0.05, 0.3};
  ContactParameters rod_base{0.01, 0.3};
  ContactParameters rod_lid{0.01, 0.3};
  ImpulseLaw law = ImpulseLaw::kNewton;
  int solver_sweeps = 1;  ///< passes over the contacts of one tick

  double dt = 4e-6;  ///< the tick [s]: the accuracy knob
  Engine engine = Engine::kScheduled;
  Start start = Start::kAligned;
  std::uint64_t seed = 1;

  friend bool operator==(const Scene&, const Scene&) = default;
};

}  // namespace shaken
