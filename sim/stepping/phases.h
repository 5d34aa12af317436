// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "sim/contact/impulse_law.h"
#include "sim/core/rng.h"
#include "sim/motion/side_walls.h"
#include "sim/stepping/rotational_noise.h"
#include "sim/stepping/tick.h"

/// Phases 1 and 3 of a tick (stepping/tick.h) as templates over the effects that take part; compose.cpp instantiates
/// them.
namespace shaken::phases {

/// Contacts without friction need neither a slip direction nor, as normals pass through the axis, the axial spin.
struct FrictionlessLaw {};

/// What the inner loops know of effects at compile time.
template <class Law, bool kImpactsAtInstant, bool kRoughPlates>
struct Effects {
  using ImpulseLaw = Law;
  static constexpr bool kFriction = !std::is_same_v<Law, FrictionlessLaw>;
  static constexpr bool kAtInstant = kImpactsAtInstant;
  static constexpr bool kRough = kRoughPlates;
};

/// One impulse and what it did to the energy of the two bodies' relative motion.
struct Impulse {
  Vec3 P;       ///< on the body that the normal points to [mg mm/s]
  double lost;  ///< -P . (u + u') / 2 [pJ]
};

/// -P . (u + K P / 2), written out so that the compiler keeps it in registers.
inline double work_lost(const Vec3& P, const Vec3& u, const Mat3& K) {
  double lost = 0;
  for (Eigen::Index r = 0; r < 3; ++r) lost -= P[r] * (u[r] + 0.5 * (K(r, 0) * P[0] + K(r, 1) * P[1] + K(r, 2) * P[2]));
  return lost;
}

/// The bead of a rod at which it is hit.
struct Struck {
  const RodKind& kind;
  RodAtTick& rod;
  double offset;
  Vec3 arm;  ///< from the centre to the contact [mm]
};

inline void take(const Struck& bead, const Vec3& P) {
  apply_impulse(bead.rod.motion, bead.kind.inverse, bead.rod.pose.director, bead.arm, P);
}

inline Impulse impulse_along(const Vec3& normal, const Vec3& u, double compliance, const ContactParameters& contact) {
  const double u_n = u.dot(normal);
  const double p = -(1.0 + contact.restitution) * u_n / compliance;
  return {p * normal, -p * (u_n + 0.5 * p * compliance)};
}

/// A free flight of `seconds`, of either sign, from or to the end of the tick.
inline void fly(RodAtTick& rod, double seconds, const RodKind& kind, double gravity) {
  Flight flight;
  flight.position = rod.pose.position;
  flight.velocity = rod.motion.velocity;
  flight.director = rod.pose.director;
  flight.spin = rod.motion.angular_velocity.dot(flight.director);
  flight.precession = rod.motion.angular_velocity - (1.0 - kind.inertia_ratio) * flight.spin * flight.director;
  flight.prepare();
  rod.pose = pose_after(flight, seconds, gravity);
  rod.motion = motion_after(flight, seconds, gravity, rod.pose.director, kind.inertia_ratio);
}

/// How long ago an overlap began if the surfaces have approached at `speed` since; none if that was not in this tick.
/// Such contacts are old: beads at rest on each other, hit again and again; they are dealt with at the tick's end.
inline std::optional<double> time_since_touch(double overlap, double speed, double dt) {
  if (!(speed > 0) || overlap > speed * dt) return {};
  return overlap / speed;
}

// ---- surfaces

/// A plate or a wall where a bead is about to be hit by it.
struct Surface {
  Vec3 normal;      ///< away from it
  double velocity;  ///< along z [mm/s]
  const ContactParameters& contact;
  double rest_speed;  ///< at which the bead must leave it at least [mm/s]
};

/// Gives the bead an impulse if it approaches.
template <class E>
[[gnu::always_inline]] inline bool hit(const Struck& bead, const Surface& surface, Counters& counters) {
  Vec3 u = point_velocity(bead.rod.motion, bead.arm);
  u.z() -= surface.velocity;
  const double u_n = u.dot(surface.normal);
  if (!(u_n < surface.rest_speed)) return false;
  const Vec3& director = bead.rod.pose.director;
  Impulse impulse;
  bool has_friction = false;
  if constexpr (E::kFriction) has_friction = surface.contact.friction != 0;
  if (has_friction) {
    if constexpr (E::kFriction) {
      const Mat3 K = point_compliance(bead.kind.inverse, director, bead.arm);
      impulse.P.setZero();
      if (u_n < 0) impulse.P = E::ImpulseLaw::impulse(K, surface.normal, u, surface.contact);
      if (surface.rest_speed > 0) {
        const double lacking = surface.rest_speed - surface.normal.dot(u + K * impulse.P);
        if (lacking > 0) impulse.P += (lacking / surface.normal.dot(K * surface.normal)) * surface.normal;
      }
      impulse.lost = work_lost(impulse.P, u, K);
    }
    take(bead, impulse.P);
  } else {
    const double compliance = normal_compliance(bead.kind.inverse, director, bead.offset, surface.normal);
    impulse = impulse_along(surface.normal, u, compliance, surface.contact);
    if (surface.rest_speed > -surface.contact.restitution * u_n) {
      const double p = (surface.rest_speed - u_n) / compliance;
      impulse = {p * surface.normal, -p * (u_n + 0.5 * p * compliance)};
    }
    apply_normal_impulse(bead.rod.motion, bead.kind.inverse, director, bead.offset, impulse.P);
  }
  bead.rod.note_hit();
  Ledger& ledger = counters.ledger;
  ledger.lost_surfaces.add(impulse.lost);
  ledger.given.add(impulse.P.z() * surface.velocity);
  for (std::size_t c = 0; c < 3; ++c) ledger.momentum[c].add(impulse.P[static_cast<Eigen::Index>(c)]);
  return true;
}

/// The bead `b` of a rod against a plate or wall that it overlaps; both move as the plates do.
template <class E>
bool meet(int b, RodAtTick& rod, const RodKind& kind, const Vec3& normal, double overlap, const PlateState& plates,
          const ContactParameters& contact, const TickRules& rules, Counters& counters) {
  const double offset = kind.species.bead_offset[b];
  const double radius = kind.species.bead_radius[b];
  const auto struck = [&] { return Struck{kind, rod, offset, offset * rod.pose.director - radius * normal}; };
  const bool rests = rules.rest.matters() && contact.restitution < 1 && normal.z() > 0;
  const double rest_speed = rests ? rules.rest.at(overlap) : 0.0;
  if constexpr (E::kAtInstant) {
    const Struck bead = struck();
    const double speed = -(point_velocity(rod.motion, bead.arm).dot(normal) - plates.velocity * normal.z());
    if (const auto ago = time_since_touch(overlap, speed, rules.dt)) {
      fly(rod, -*ago, kind, rules.gravity);
      const bool was_hit =
          hit<E>(struck(), {normal, rules.plates.before(plates, *ago).velocity, contact, rest_speed}, counters);
      fly(rod, *ago, kind, rules.gravity);
      if (was_hit) {
        rod.displaced = true;
        ++counters.impacts_at_instant;
        return true;
      }
    }
  }
  return hit<E>(struck(), {normal, plates.velocity, contact, rest_speed}, counters);
}

/// Looks for the deepest of a rod's beads in its surfaces. No bead order and no sign of the director has a say: two of
/// the same depth come by where they lie, so a rod turned end for end meets its surfaces in the same way.
class Deepest {
 public:
  explicit Deepest(const Vec3& director) : director_(director) {}

  void see(int item, double offset, double overlap) {
    if (!(overlap > 0) || overlap < overlap_ || (overlap == overlap_ && !lies_before(offset))) return;
    item_ = item;
    offset_ = offset;
    overlap_ = overlap;
  }
  bool found() const { return item_ >= 0; }
  int item() const { return item_; }
  double overlap() const { return overlap_; }

 private:
  bool lies_before(double offset) const {
    const Vec3 here = offset * director_;
    const Vec3 there = offset_ * director_;
    return std::lexicographical_compare(here.begin(), here.end(), there.begin(), there.end());
  }

  const Vec3& director_;
  int item_ = -1;
  double offset_ = 0;
  double overlap_ = 0;
};

inline NumericalTrouble too_deep(Tick now, int index, int bead, double overlap, const char* where) {
  return {now, {index}, "bead " + std::to_string(bead) + " is " + std::to_string(overlap) + " mm deep in the " + where};
}

template <class E>
std::optional<NumericalTrouble> meet_plates(int index, RodAtTick& rod, const Flight& flight, const PlateState& plates,
                                            Tick now, const TickRules& rules, Counters& counters) {
  const RodKind& kind = rules.kind_of(index);
  const Species& species = kind.species;
  {
    // quick way out for most rods
    const double z = rod.pose.position.z();
    const double extent =
        std::max(species.mid_radius, species.end_radius + species.half_length * std::abs(rod.pose.director.z()));
    if (z - extent >= plates.base && z + extent <= plates.lid) return {};
  }
  int n_hits = 0;
  for (const double side : {1.0, -1.0}) {  // +1: base, pushes up; -1: lid, pushes down
    if (!(side > 0 ? rules.has_base : rules.has_lid)) continue;
    const double plate = side > 0 ? plates.base : plates.lid;
    const ContactParameters& contact = side > 0 ? rules.rod_base : rules.rod_lid;
    std::bitset<kMostBeads> met;
    while (true) {  // one bead after the other, the deepest first, as the rod is by then
      Deepest deepest(rod.pose.director);
      for (const int bead : species.outer_beads) {
        const double offset = species.bead_offset[bead];
        const double above = side * (rod.pose.position.z() + offset * rod.pose.director.z() - plate);
        if (!met[bead]) deepest.see(bead, offset, species.bead_radius[bead] - above);
      }
      if (!deepest.found()) break;
      const int bead = deepest.item();
      const double radius = species.bead_radius[bead];
      const double overlap = deepest.overlap();
      met.set(bead);
      if (overlap > kMaxOverlapFraction * radius) return too_deep(now, index, bead, overlap, side > 0 ? "base" : "lid");
      evaluate_motion(rod, flight, now, kind, rules);
      counters.max_overlap_rod_plate = std::max(counters.max_overlap_rod_plate, overlap);
      double speed = 0;  // of the hit
      if constexpr (E::kRough) {
        const Vec3 arm = species.bead_offset[bead] * rod.pose.director - radius * side * Vec3::UnitZ();
        speed = std::abs(point_velocity(rod.motion, arm).z() - plates.velocity);
      }
      if (!meet<E>(bead, rod, kind, Vec3(0, 0, side), overlap, plates, contact, rules, counters)) continue;
      ++(side > 0 ? counters.impulses_rod_base : counters.impulses_rod_lid);
      if (E::kRough && rules.rotational_noise > 0)
        turn_at_random(index, n_hits, rod, kind, speed, now, rules, counters);
      ++n_hits;
    }
  }
  return {};
}

template <class E>
std::optional<NumericalTrouble> meet_side_walls(int index, RodAtTick& rod, const Flight& flight,
                                                const PlateState& plates, Tick now, const TickRules& rules,
                                                Counters& counters) {
  const RodKind& kind = rules.kind_of(index);
  const Species& species = kind.species;
  const SideWalls& walls = *rules.walls;
  if (distance_to_walls(walls, rules.box_side, rod.pose.position) >= species.half_length + species.max_radius)
    return {};
  const auto seen_by = [&](int bead) {
    return see_walls(walls, rules.box_side, rod.pose.position + species.bead_offset[bead] * rod.pose.director);
  };
  std::bitset<2 * kMostBeads> met;  // of each bead one wall or two
  while (true) {
    Deepest deepest(rod.pose.director);
    for (int bead = 0; bead < species.n_beads(); ++bead) {
      const WallsSeen seen = seen_by(bead);
      for (int w = 0; w < seen.n; ++w) {
        const int item = 2 * bead + w;
        if (!met[item])
          deepest.see(item, species.bead_offset[bead], species.bead_radius[bead] - seen.walls[w].distance);
      }
    }
    if (!deepest.found()) return {};
    const int bead = deepest.item() / 2;
    const double overlap = deepest.overlap();
    met.set(deepest.item());
    if (overlap > kMaxOverlapFraction * species.bead_radius[bead])
      return too_deep(now, index, bead, overlap, "side wall");
    evaluate_motion(rod, flight, now, kind, rules);
    counters.max_overlap_rod_plate = std::max(counters.max_overlap_rod_plate, overlap);
    const Vec3 normal = seen_by(bead).walls[deepest.item() % 2].normal;
    if (meet<E>(bead, rod, kind, normal, overlap, plates, walls.contact, rules, counters)) ++counters.impulses_rod_wall;
  }
}

template <class E>
std::optional<NumericalTrouble> meet_surfaces(int index, RodAtTick& rod, const Flight& flight, const PlateState& plates,
                                              Tick now, const TickRules& rules, Counters& counters) {
  if (rules.has_base || rules.has_lid) {
    if (auto trouble = meet_plates<E>(index, rod, flight, plates, now, rules, counters)) return trouble;
  }
  if (rules.walls) return meet_side_walls<E>(index, rod, flight, plates, now, rules, counters);
  return {};
}

// ---- rods with each other

/// Gives both rods an impulse if their beads approach.
template <class E>
[[gnu::always_inline]] inline bool collide(const Struck& i, const Struck& j, const Vec3& normal,
                                           const ContactParameters& contact, Counters& counters) {
  const Vec3 u = point_velocity(j.rod.motion, j.arm) - point_velocity(i.rod.motion, i.arm);
  if (!(u.dot(normal) < 0)) return false;
  const Vec3& n_i = i.rod.pose.director;
  const Vec3& n_j = j.rod.pose.director;
  Impulse impulse;
  if constexpr (E::kFriction) {
    if (contact.friction != 0) {
      const Mat3 K = point_compliance(i.kind.inverse, n_i, i.arm) + point_compliance(j.kind.inverse, n_j, j.arm);
      impulse.P = E::ImpulseLaw::impulse(K, normal, u, contact);
      impulse.lost = work_lost(impulse.P, u, K);
      take(j, impulse.P);
      take(i, -impulse.P);
      i.rod.note_hit();
      j.rod.note_hit();
      counters.ledger.lost_rod_rod.add(impulse.lost);
      return true;
    }
  }
  const double compliance = normal_compliance(i.kind.inverse, n_i, i.offset, normal) +
                            normal_compliance(j.kind.inverse, n_j, j.offset, normal);
  impulse = impulse_along(normal, u, compliance, contact);
  apply_normal_impulse(j.rod.motion, j.kind.inverse, n_j, j.offset, impulse.P);
  apply_normal_impulse(i.rod.motion, i.kind.inverse, n_i, i.offset, -impulse.P);
  i.rod.note_hit();
  j.rod.note_hit();
  counters.ledger.lost_rod_rod.add(impulse.lost);
  return true;
}

/// One contact. The motion of both rods must have been evaluated.
template <class E>
void respond_to(const PairContact& contact, RodAtTick& rod_i, RodAtTick& rod_j, const TickRules& rules,
                Counters& counters) {
  const BeadContact& beads = contact.beads;
  const RodKind& kind_i = rules.kind_of(contact.i);
  const RodKind& kind_j = rules.kind_of(contact.j);
  const double offset_i = kind_i.species.bead_offset[beads.bead_i];
  const double offset_j = kind_j.species.bead_offset[beads.bead_j];
  const double radius_i = kind_i.species.bead_radius[beads.bead_i];
  const double radius_j = kind_j.species.bead_radius[beads.bead_j];
  const auto collide_along = [&](const Vec3& normal) {
    return collide<E>({kind_i, rod_i, offset_i, offset_i * rod_i.pose.director + radius_i * normal},
                      {kind_j, rod_j, offset_j, offset_j * rod_j.pose.director - radius_j * normal}, normal,
                      rules.rod_rod, counters);
  };
  if constexpr (E::kAtInstant) {
    // from bead to bead as the rods are now: an impulse of the same tick may have displaced them since detection
    const auto bead_to_bead = [&]() -> Vec3 {
      return nearest_image(rod_i.pose.position, rod_j.pose.position, rules.box_side) + offset_j * rod_j.pose.director -
             offset_i * rod_i.pose.director;
    };
    const Vec3 r = bead_to_bead();
    const double distance = r.norm();
    const double overlap = radius_i + radius_j - distance;
    if (!(overlap > 0)) return;
    const Vec3 normal = distance > 0 ? Vec3(r / distance) : beads.normal;
    const double speed = (point_velocity(rod_i.motion, offset_i * rod_i.pose.director) -
                          point_velocity(rod_j.motion, offset_j * rod_j.pose.director))
                             .dot(normal);
    if (const auto ago = time_since_touch(overlap, speed, rules.dt)) {
      fly(rod_i, -*ago, kind_i, rules.gravity);
      fly(rod_j, -*ago, kind_j, rules.gravity);
      const bool have_hit = collide_along(bead_to_bead().normalized());
      fly(rod_i, *ago, kind_i, rules.gravity);
      fly(rod_j, *ago, kind_j, rules.gravity);
      if (have_hit) {
        rod_i.displaced = rod_j.displaced = true;
        ++counters.impacts_at_instant;
        ++counters.impulses_rod_rod;
        return;
      }
    }
    if (collide_along(normal)) ++counters.impulses_rod_rod;
  } else {
    if (collide_along(beads.normal)) ++counters.impulses_rod_rod;
  }
}

/// Trouble if the overlap of a contact is too deep.
inline std::optional<NumericalTrouble> check_overlap(const PairContact& contact, Tick now, const TickRules& rules) {
  const double smaller = std::min(rules.kind_of(contact.i).species.bead_radius[contact.beads.bead_i],
                                  rules.kind_of(contact.j).species.bead_radius[contact.beads.bead_j]);
  if (contact.beads.overlap <= kMaxOverlapFraction * smaller) return {};
  return NumericalTrouble{now,
                          {contact.i, contact.j},
                          "beads " + std::to_string(contact.beads.bead_i) + " and " +
                              std::to_string(contact.beads.bead_j) + " overlap by " +
                              std::to_string(contact.beads.overlap) + " mm"};
}

/// The contacts of a tick in the order in which they get their impulses, if that is not the sorted one. What a contact
/// draws depends on its rods and on which of theirs it is: steppers may leave out pairs that cannot take part.
inline std::vector<PairContact> in_order(const std::vector<PairContact>& sorted, const Scene& scene, Tick now) {
  std::vector<PairContact> contacts(sorted.rbegin(), sorted.rend());
  if (scene.order == ContactOrder::kReversed) return contacts;
  struct Drawn {
    std::uint64_t number;
    PairContact contact;
  };
  std::vector<Drawn> drawn;
  std::uint64_t rank = 0;  // among those of the pair
  for (std::size_t c = 0; c < sorted.size(); ++c) {
    const PairContact& contact = sorted[c];
    rank = c > 0 && sorted[c - 1].i == contact.i && sorted[c - 1].j == contact.j ? rank + 1 : 0;
    const auto index =
        (static_cast<std::uint64_t>(contact.i) << 40) ^ (static_cast<std::uint64_t>(contact.j) << 16) ^ rank;
    Rng rng(scene.seed, RngStream::kContacts, now, index);
    drawn.push_back({rng.bits(), contact});
  }
  std::stable_sort(drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) { return a.number < b.number; });
  std::transform(drawn.begin(), drawn.end(), contacts.begin(), [](const Drawn& d) { return d.contact; });
  return contacts;
}

template <class E>
std::optional<NumericalTrouble> respond(const std::vector<PairContact>& contacts, std::vector<RodAtTick>& rods,
                                        World& world, Tick now, const TickRules& rules) {
  for (const PairContact& contact : contacts) {
    if (auto trouble = check_overlap(contact, now, rules)) return trouble;
    world.counters.max_overlap_rod_rod = std::max(world.counters.max_overlap_rod_rod, contact.beads.overlap);
    for (const int i : {contact.i, contact.j}) evaluate_motion(rods[i], world.rods[i], now, rules.kind_of(i), rules);
  }
  const auto pass_over = [&](const std::vector<PairContact>& ordered) {
    for (int sweep = 0; sweep < world.scene.solver_sweeps; ++sweep) {
      for (const PairContact& contact : ordered) {
        respond_to<E>(contact, rods[contact.i], rods[contact.j], rules, world.counters);
      }
    }
  };
  if (world.scene.order == ContactOrder::kSorted) {
    pass_over(contacts);
  } else {
    pass_over(in_order(contacts, world.scene, now));
  }
  return {};
}

}  // namespace shaken::phases
