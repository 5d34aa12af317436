// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "sim/contact/bead_contacts.h"
#include "sim/contact/impulse_law.h"
#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/neighbors/neighbor_list.h"
#include "sim/world.h"

/// What a tick means: the one definition that all steppers share. At tick k, in this order:
///   1. plates:     every rod against base and lid; of each plate the lower end, centre and upper bead in bead order
///   2. detection:  overlapping bead pairs of every neighbour pair, from the poses at tick k
///   3. response:   those contacts, sorted by (i, j, bead of i, bead of j), each that approaches gets an impulse
///   4. storing:    rods whose velocity changed begin a new flight at tick k
/// Impulses change no pose, so no phase depends on the order in which a loop visits rods or pairs, and a rod or pair
/// without contact is left untouched down to the last bit.
namespace shaken {

/// Everything about a world that stays the same from tick to tick, in the form that the phases need.
struct TickRules {
  explicit TickRules(const World& world)
      : species(world.species),
        inverse(inverse_inertia(world.species)),
        inertia_ratio(world.species.inertia_par / world.species.inertia_perp),
        gravity(world.scene.gravity),
        dt(world.scene.dt),
        box_side(world.scene.box_side),
        rod_rod(world.scene.rod_rod),
        rod_base(world.scene.rod_base),
        rod_lid(world.scene.rod_lid),
        law(world.scene.law) {}

  Species species;
  InverseInertia inverse;
  double inertia_ratio;  ///< I_par / I_perp
  double gravity;
  double dt;
  double box_side;
  ContactParameters rod_rod, rod_base, rod_lid;
  ImpulseLaw law;
};

/// A rod during one tick.
struct RodAtTick {
  Pose pose;
  Motion motion;            ///< evaluated when first needed
  bool has_motion = false;  ///< `motion` has been evaluated
  bool changed = false;     ///< an impulse changed `motion`
};

/// Overlap beyond this fraction of the smaller radius ends the run: the contact's normal would soon lose its meaning.
/// At 4 us the paper's scenes stay below 0.02.
inline constexpr double kMaxOverlapFraction = 0.5;

inline RodAtTick rod_at_tick(const Flight& flight, Tick now, const TickRules& rules) {
  return {pose_after(flight, static_cast<double>(now - flight.since) * rules.dt, rules.gravity), {}, false, false};
}

/// Makes the rod's motion at the tick available.
inline void evaluate_motion(RodAtTick& rod, const Flight& flight, Tick now, const TickRules& rules) {
  if (rod.has_motion) return;
  rod.motion = motion_after(flight, static_cast<double>(now - flight.since) * rules.dt, rules.gravity,
                            rod.pose.director, rules.inertia_ratio);
  rod.has_motion = true;
}

/// Phase 1 for one rod: only an end bead or the centre bead can be the lowest or the highest, as the taper is linear.
/// Returns trouble if a bead is too deep in a plate.
inline std::optional<NumericalTrouble> collide_with_plates(int index, RodAtTick& rod, const Flight& flight,
                                                           const PlateState& plates, Tick now, const TickRules& rules,
                                                           Counters& counters) {
  const Species& species = rules.species;
  const double z = rod.pose.position.z();
  const double n_z = rod.pose.director.z();
  // quick way out for most rods
  const double extent = std::max(species.mid_radius, species.end_radius + species.half_length * std::abs(n_z));
  if (z - extent >= plates.base && z + extent <= plates.lid) return {};

  const int last = species.n_beads() - 1;
  const int beads[3] = {0, last / 2, last};
  const int first_candidate = last > 0 ? 0 : 2;  // a sphere has one bead
  for (const double side : {1.0, -1.0}) {        // +1: base, pushes up; -1: lid, pushes down
    const double plate = side > 0 ? plates.base : plates.lid;
    for (int c = first_candidate; c < 3; ++c) {
      const int bead = beads[c];
      const double radius = species.bead_radius[bead];
      const double offset = species.bead_offset[bead];
      const double overlap = radius - side * (z + offset * n_z - plate);
      if (!(overlap > 0)) continue;
      if (overlap > kMaxOverlapFraction * radius) {
        return NumericalTrouble{now,
                                {index},
                                "bead " + std::to_string(bead) + " is " + std::to_string(overlap) + " mm deep in the " +
                                    (side > 0 ? "base" : "lid")};
      }
      evaluate_motion(rod, flight, now, rules);
      const Vec3 normal(0, 0, side);
      const Vec3 arm = offset * rod.pose.director - radius * normal;
      Vec3 u = point_velocity(rod.motion, arm);
      u.z() -= plates.velocity;
      counters.max_overlap_rod_plate = std::max(counters.max_overlap_rod_plate, overlap);
      if (!(u.dot(normal) < 0)) continue;
      const Mat3 K = point_compliance(rules.inverse, rod.pose.director, arm);
      const Vec3 P = impulse_by(rules.law, K, normal, u, side > 0 ? rules.rod_base : rules.rod_lid);
      apply_impulse(rod.motion, rules.inverse, rod.pose.director, arm, P);
      rod.changed = true;
      ++(side > 0 ? counters.impulses_rod_base : counters.impulses_rod_lid);
    }
  }
  return {};
}

/// A bead contact of two rods, as response needs it.
struct PairContact {
  int i;
  int j;
  BeadContact beads;
};

/// Trouble if the overlap of a contact is too deep.
inline std::optional<NumericalTrouble> check_overlap(const PairContact& contact, Tick now, const TickRules& rules) {
  const double smaller =
      std::min(rules.species.bead_radius[contact.beads.bead_i], rules.species.bead_radius[contact.beads.bead_j]);
  if (contact.beads.overlap <= kMaxOverlapFraction * smaller) return {};
  return NumericalTrouble{now,
                          {contact.i, contact.j},
                          "beads " + std::to_string(contact.beads.bead_i) + " and " +
                              std::to_string(contact.beads.bead_j) + " overlap by " +
                              std::to_string(contact.beads.overlap) + " mm"};
}

/// Phase 3 for one contact. The motion of both rods must have been evaluated.
inline void respond_to(const PairContact& contact, RodAtTick& rod_i, RodAtTick& rod_j, const TickRules& rules,
                       Counters& counters) {
  const BeadContact& beads = contact.beads;
  const Species& species = rules.species;
  const Vec3 arm_i =
      species.bead_offset[beads.bead_i] * rod_i.pose.director + species.bead_radius[beads.bead_i] * beads.normal;
  const Vec3 arm_j =
      species.bead_offset[beads.bead_j] * rod_j.pose.director - species.bead_radius[beads.bead_j] * beads.normal;
  const Vec3 u = point_velocity(rod_j.motion, arm_j) - point_velocity(rod_i.motion, arm_i);
  if (!(u.dot(beads.normal) < 0)) return;
  const Mat3 K = point_compliance(rules.inverse, rod_i.pose.director, arm_i) +
                 point_compliance(rules.inverse, rod_j.pose.director, arm_j);
  const Vec3 P = impulse_by(rules.law, K, beads.normal, u, rules.rod_rod);
  apply_impulse(rod_j.motion, rules.inverse, rod_j.pose.director, arm_j, P);
  apply_impulse(rod_i.motion, rules.inverse, rod_i.pose.director, arm_i, -P);
  rod_i.changed = true;
  rod_j.changed = true;
  ++counters.impulses_rod_rod;
}

/// Phase 3. `contacts` are sorted; `rods` holds those concerned as of tick `now`.
inline std::optional<NumericalTrouble> respond(const std::vector<PairContact>& contacts, std::vector<RodAtTick>& rods,
                                               World& world, Tick now, const TickRules& rules) {
  for (const PairContact& contact : contacts) {
    if (auto trouble = check_overlap(contact, now, rules)) return trouble;
    world.counters.max_overlap_rod_rod = std::max(world.counters.max_overlap_rod_rod, contact.beads.overlap);
    evaluate_motion(rods[contact.i], world.rods[contact.i], now, rules);
    evaluate_motion(rods[contact.j], world.rods[contact.j], now, rules);
  }
  for (int sweep = 0; sweep < world.scene.solver_sweeps; ++sweep) {
    for (const PairContact& contact : contacts) {
      respond_to(contact, rods[contact.i], rods[contact.j], rules, world.counters);
    }
  }
  return {};
}

/// Phase 4 for one changed rod. Trouble if its motion is no longer a number.
inline std::optional<NumericalTrouble> store(int index, Flight& flight, const RodAtTick& rod, Tick now,
                                             const TickRules& rules) {
  const double sum = rod.motion.velocity.sum() + rod.motion.angular_velocity.sum() + rod.pose.position.sum();
  if (!std::isfinite(sum)) return NumericalTrouble{now, {index}, "velocity or position is not a finite number"};
  begin_flight(flight, now, rod.pose, rod.motion, rules.box_side, rules.inertia_ratio);
  return {};
}

}  // namespace shaken
