#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/contact/bead_contacts.h"
#include "sim/contact/impulse_law.h"
#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/motion/post_grid.h"
#include "sim/motion/rest_speed.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/world.h"

/// What a tick means: the one definition that all steppers share. At tick k, in this order:
///   1. surfaces:   every rod against base, lid, side walls and posts, in this order; of each the deepest bead first
///   2. detection:  overlapping bead pairs of every neighbour pair, from the poses at tick k
///   3. response:   those contacts, sorted by (i, j, depth), each that approaches gets an impulse
///   4. storing:    rods whose velocity changed begin a new flight at tick k
/// Detection takes poses as free flight brought them, so no phase depends on the order in which a loop visits rods or
/// pairs, and a rod or pair without contact is left untouched down to the last bit. None depends on which end of a rod
/// is called its head either: a rod that is the same fore and aft, turned end for end, flies the same, down to the last
/// bit.
///
/// Phases 1 and 3 are in tick/surface_impacts.h and tick/rod_impacts.h. What an effect does there stands behind
/// the same predicate of the scene (sim/system.h) that the registry of effects asks (sim/effects/registry.h).
namespace shaken {

/// A species with what impulses need to know of it and its contacts.
struct SpeciesMechanics : Species {
  explicit SpeciesMechanics(const Species& species) : Species(species), inverse(inverse_inertia(species)) {}
  InverseInertia inverse;
  ContactParameters base{}, lid{}, wall{}, post{};
  std::array<ContactParameters, kMostSpecies> rods{};  ///< with each species
  std::size_t number = 0;                              ///< of the species, among those
  double rotational_noise = 0;                         ///< [rad/mm]
  bool has_rotational_noise() const { return rotational_noise > 0; }
};

/// Rate at which rods at rest on the base come out of it again [1/s].
inline constexpr double kRiseRate = 20.0;

/// A rod that is faster than this many times the speeds that the scene has by itself is trouble.
inline constexpr double kMaxSpeedFactor = 100.0;

/// kMaxSpeedFactor times the plates' speed, that of a fall through the gap and that of the start together; but never
/// more than the thinnest bead's radius in a tick, beyond which beads could pass through each other unseen [mm/s].
double max_speed(const World& world);

/// Everything about a world that stays the same from tick to tick, in the form that the phases need.
struct TickRules {
  explicit TickRules(const World& world);

  const SpeciesMechanics& species_of(int i) const { return species[shape_of_rod[static_cast<std::size_t>(i)]]; }
  /// The contact of two rods.
  const ContactParameters& rod_rod(int i, int j) const { return species_of(i).rods[species_of(j).number]; }

  System system;
  std::vector<SpeciesMechanics> species;   ///< (n_shapes) each size of each species
  std::vector<std::uint8_t> shape_of_rod;  ///< (n_rods)
  Gravity gravity;
  double dt;
  Box box;                  ///< sides along x and y [mm]
  ImpulseFunction impulse;  ///< of contacts with friction
  std::optional<PostGrid> posts;
  bool has_uprights() const { return system.walls || posts; }
  PlateMotion plates;
  double max_speed2;  ///< [mm^2/s^2]
  RestSpeed rest;
};

/// A rod during one tick.
struct RodAtTick {
  Pose pose;
  Motion motion;            ///< evaluated when first needed
  bool has_motion = false;  ///< `motion` has been evaluated
  bool changed = false;     ///< an impulse changed `motion`
  bool displaced = false;   ///< one changed `pose` too, by taking place earlier within the tick
};

/// Overlap beyond this fraction of the smaller radius ends the run: the contact's normal would soon lose its meaning.
/// At 4 us the paper's scenes stay below 0.02.
inline constexpr double kMaxOverlapFraction = 0.5;

inline RodAtTick rod_at_tick(const Flight& flight, Tick now, const TickRules& rules) {
  return {
      pose_after(flight, static_cast<double>(now - flight.since) * rules.dt, rules.gravity), {}, false, false, false};
}

/// Velocity of the rod's centre at the tick [mm/s].
inline Vec3 velocity_at(const Flight& flight, Tick now, const TickRules& rules) {
  return velocity_after(flight, static_cast<double>(now - flight.since) * rules.dt, rules.gravity);
}

/// Makes the rod's motion at the tick available.
inline void evaluate_motion(RodAtTick& rod, const Flight& flight, Tick now, const SpeciesMechanics& species,
                            const TickRules& rules) {
  if (rod.has_motion) return;
  rod.motion = motion_after(flight, static_cast<double>(now - flight.since) * rules.dt, rules.gravity,
                            rod.pose.director, species.inertia_ratio);
  rod.has_motion = true;
}

/// A bead contact of two rods, as response needs it.
struct PairContact {
  int i;
  int j;
  BeadContact beads;
};

/// Sorts contacts into the order of response: by rods, of each pair the deepest first. Two of the same depth come by
/// where they lie, so that no bead order has a say. `rods` holds those concerned.
void sort_contacts(std::vector<PairContact>& contacts, const std::vector<RodAtTick>& rods, const TickRules& rules);

/// Whether the motion of a changed rod is still a number, and in proportion. To be asked of every one before phase 4:
/// if it is not, there is trouble, and the world stays what it was one tick before.
inline bool has_sound_motion(const RodAtTick& rod, const TickRules& rules) {
  return rod.motion.velocity.squaredNorm() <= rules.max_speed2 &&
         std::isfinite(rod.motion.angular_velocity.sum() + rod.pose.position.sum());
}
/// What is wrong with a motion that is not sound.
NumericalTrouble motion_trouble(int index, const RodAtTick& rod, Tick now, const TickRules& rules);

/// Phase 4 for one changed rod.
inline void store(int index, Flight& flight, const RodAtTick& rod, Tick now, const TickRules& rules) {
  begin_flight(flight, now, rod.pose, rod.motion, rules.box, rules.species_of(index).inertia_ratio);
}

}  // namespace shaken
