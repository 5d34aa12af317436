// SPDX-License-Identifier: MIT
#include "sim/tick/plate_impacts.h"

#include <algorithm>
#include <string_view>

#include "base/core/sincos.h"
#include "sim/contact/cofactors.h"

namespace shaken {
namespace {

/// The effects that the lanes know. Those between rods, at side walls and at posts take place elsewhere.
constexpr std::string_view kKnownEffects[] = {"gravity",
                                              "vibration",
                                              "tilt",
                                              "species",
                                              "taper",
                                              "spin",
                                              "rod_rod_collisions",
                                              "rod_rod_friction",
                                              "rod_rod_restitution",
                                              "rod_base_collisions",
                                              "rod_base_friction",
                                              "rod_base_restitution",
                                              "rod_lid_collisions",
                                              "rod_lid_friction",
                                              "rod_lid_restitution",
                                              "side_walls",
                                              "side_wall_friction",
                                              "posts",
                                              "post_friction",
                                              "rotational_noise",
                                              "impacts_at_instant",
                                              "horizontal_vibration",
                                              "second_vibration",
                                              "lid_motion",
                                              "inclination",
                                              "restitution_speed",
                                              "species_contacts"};

using lanes::Doubles;
using lanes::kDoubleLanes;
using lanes::Triple;

using lanes::TripleLanes;

/// Flights of several rods, component by component: what poses and motions at a later tick follow from.
struct FlightLanes {
  TripleLanes position, velocity, along, across, turned, precession;
  alignas(64) double spin[kDoubleLanes];
  alignas(64) double rate[kDoubleLanes];

  void set(int lane, const Flight& flight) {
    position.set(lane, flight.position);
    velocity.set(lane, flight.velocity);
    along.set(lane, flight.along);
    across.set(lane, flight.across);
    turned.set(lane, flight.turned);
    precession.set(lane, flight.precession);
    spin[lane] = flight.spin;
    rate[lane] = flight.rate;
  }
};

/// What the plates do to several rods at a tick.
struct PlateHits {
  /// Of one plate.
  struct OfPlate {
    TripleLanes impulse;
    alignas(64) double lost[kDoubleLanes];     ///< energy
    alignas(64) double overlap[kDoubleLanes];  ///< of the bead in the plate; 0: none
    alignas(64) double is_hit[kDoubleLanes];   ///< > 0: yes, where there is an overlap
    alignas(64) double bead[kDoubleLanes];     ///< its number, where impulses are left to others
  };
  TripleLanes position, director, velocity, angular_velocity;  ///< of the rods after the hits, if they are given here
  OfPlate of_plate[2];                                         ///< base, lid
  alignas(64) double is_other[kDoubleLanes];                   ///< >= 0: what happens is not known here

  bool is_known(int lane) const { return is_other[lane] < 0; }
  bool meets(int lane, int plate) const { return of_plate[plate].overlap[lane] > 0; }
  bool is_hit(int lane, int plate) const { return meets(lane, plate) && of_plate[plate].is_hit[lane] > 0; }

  /// Counts the lane's hits.
  void count(int lane, const Vec3& base_velocity, const Vec3& lid_velocity, Counters& counters) const;
  /// The lane's rod after them; its motion only where a bead is in a plate.
  void get(int lane, RodAtTick& rod) const;
  /// The lane's rod before them, and which beads they are going to hit, where impulses are left to others.
  void get_before(int lane, RodAtTick& rod) const;
  BeadsInPlates beads(int lane) const;
};

/// A symmetric matrix, as point_compliance (contact/impulse.h) makes it.
template <class D>
struct Compliance {
  D xx, xy, xz, yx, yy, yz, zx, zy, zz;

  SHAKEN_INLINE Triple<D> operator*(const Triple<D>& v) const {
    return {xx * v.x + (xy * v.y + xz * v.z), yx * v.x + (yy * v.y + yz * v.z), zx * v.x + (zy * v.y + zz * v.z)};
  }
};

template <class D>
SHAKEN_INLINE Compliance<D> compliance_at(const InverseInertia& inverse, const Triple<D>& director,
                                          const Triple<D>& arm) {
  const Triple<D> lever = director.cross(arm);
  const double more = inverse.par - inverse.perp;
  const Triple<D> l{more * lever.x, more * lever.y, more * lever.z};
  const Triple<D> a{inverse.perp * arm.x, inverse.perp * arm.y, inverse.perp * arm.z};
  const D round = inverse.mass + inverse.perp * arm.squared_norm();
  return {(l.x * lever.x - a.x * arm.x) + round, l.x * lever.y - a.x * arm.y,
          l.x * lever.z - a.x * arm.z,           l.y * lever.x - a.y * arm.x,
          (l.y * lever.y - a.y * arm.y) + round, l.y * lever.z - a.y * arm.z,
          l.z * lever.x - a.z * arm.x,           l.z * lever.y - a.z * arm.y,
          (l.z * lever.z - a.z * arm.z) + round};
}

/// Where a rod meets a plate.
struct PlateMet {
  double side;    ///< +1: base, -1: lid
  double height;  ///< [mm]
  Vec3 velocity;  ///< [mm/s]
  const ContactParameters& contact;
};

/// `kGivesImpulses`: or else hits are left to meet_surfaces_from.
template <bool kGivesImpulses>
struct PlateHitKernel {
  const SpeciesMechanics& species;
  const TickRules& rules;
  const PlateState& plates;
  const FlightLanes& flights;
  const double* since;  ///< how long each has flown [s]
  int n;
  PlateHits& hits;

  template <int W>
  SHAKEN_INLINE void run() const {
    for (int l = 0; l < n; l += W) meet<W>(l);
  }

  template <int W>
  SHAKEN_INLINE void meet(int l) const {
    using D = Doubles<W>;
    const D tau = lanes::load<W>(since + l);
    const D angle = lanes::load<W>(flights.rate + l) * tau;
    const SinCosOf<D> turn = sincos_of_small(angle);
    const Triple<D> start_velocity = flights.velocity.load<W>(l);
    Triple<D> position = flights.position.load<W>(l) + tau * start_velocity;
    const Gravity& gravity = rules.gravity;
    position.z -= 0.5 * gravity.down * tau * tau;
    if (gravity.is_inclined) [[unlikely]] {
      position.x += 0.5 * gravity.along.x() * tau * tau;
      position.y += 0.5 * gravity.along.y() * tau * tau;
    }
    const Triple<D> director =
        flights.along.load<W>(l) + turn.cos * flights.across.load<W>(l) + turn.sin * flights.turned.load<W>(l);
    hits.position.store(l, position);
    hits.director.store(l, director);

    Triple<D> velocity = start_velocity;
    velocity.z -= gravity.down * tau;
    if (gravity.is_inclined) [[unlikely]] {
      velocity.x += gravity.along.x() * tau;
      velocity.y += gravity.along.y() * tau;
    }
    const D spin = (1.0 - species.inertia_ratio) * lanes::load<W>(flights.spin + l);
    Triple<D> angular_velocity = flights.precession.load<W>(l) + spin * director;

    // Not known here: a large turn, or several beads in one plate. Of a rod that the base hits in a way that is not
    // known, what comes next is no number, which `larger` passes over where it stands first.
    D other = lanes::absolute(angle) - kLargestSmallAngle;
    const auto meet_plate = [&](const PlateMet& plate, PlateHits::OfPlate& hit) __attribute__((always_inline)) {
      // as meet_plates passes over rods that are out of reach
      const D at_ends = species.end_radius + species.half_length * lanes::absolute(director.z);
      const D extent = lanes::larger(lanes::all<W>(species.mid_radius), at_ends);
      const D within_reach = plate.side * plate.height - plate.side * (position.z - plate.side * extent);
      D overlap{}, offset{}, n_overlapping{};
      D radius = lanes::all<W>(1.0);
      [[maybe_unused]] D found{};
      for (const int bead : species.outer_beads) {
        const double r = species.bead_radius[bead];
        const D above = plate.side * (position.z + species.bead_offset[bead] * director.z - plate.height);
        const D deep = r - above;
        const D overlaps = lanes::smaller(deep, within_reach);
        n_overlapping = overlaps > 0.0 ? n_overlapping + 1.0 : n_overlapping;
        offset = overlaps > 0.0 ? lanes::all<W>(species.bead_offset[bead]) : offset;
        radius = overlaps > 0.0 ? lanes::all<W>(r) : radius;
        overlap = overlaps > 0.0 ? deep : overlap;
        if constexpr (!kGivesImpulses) found = overlaps > 0.0 ? lanes::all<W>(static_cast<double>(bead)) : found;
      }
      other = lanes::larger(n_overlapping - 1.5, other);
      other = lanes::larger(overlap - kMaxOverlapFraction * radius, other);
      lanes::store(hit.overlap + l, overlap);
      if constexpr (!kGivesImpulses) {
        lanes::store(hit.bead + l, found);
        return;
      }
      bool is_met = false;
      for (int lane = 0; lane < W; ++lane) is_met |= overlap[lane] > 0;
      if (!is_met) return;  // as a rule a vector of rods meets one plate, where they rest

      const D zero{};
      const Triple<D> normal{zero, zero, lanes::all<W>(plate.side)};
      const Triple<D> arm = offset * director - radius * normal;
      Triple<D> u = velocity + angular_velocity.cross(arm);
      u.z -= plate.velocity.z();
      if (rules.has_horizontal_vibration) {
        u.x -= plate.velocity.x();
        u.y -= plate.velocity.y();
      }
      const D u_n = u.dot(normal);
      const D is_hit = lanes::smaller(overlap, -u_n);

      // newton_coulomb_impulse
      const Compliance<D> K = compliance_at(species.inverse, director, arm);
      const double mu = plate.contact.friction;
      const D bounce = -(1.0 + plate.contact.restitution) * u_n;
      const Triple<D> u_t = u - u_n * normal;
      const Triple<D> wanted = bounce * normal - u_t;
      const auto stick =
          Cofactors<D>(K.xx, K.yy, K.zz, K.xy, K.xz, K.yz).template solve<Triple<D>>(wanted.x, wanted.y, wanted.z);
      const D stick_n = stick.dot(normal);
      const Triple<D> stick_t = stick - stick_n * normal;
      const D stick_t2 = stick_t.squared_norm();
      const D speed_t = lanes::square_root(u_t.squared_norm());
      const Triple<D> cone = normal - (mu / speed_t) * u_t;
      const D gain = normal.dot(K * cone);
      const Triple<D> slip = (bounce / gain) * cone;
      const D in_cone = mu * mu * stick_n * stick_n - stick_t2;
      const D sticks = stick_n > 0.0 ? in_cone : -1.0 - stick_t2;  // >= 0: yes
      const auto if_sticks = [&](const D& then, const D& otherwise) __attribute__((always_inline)) {
        return sticks >= 0.0 ? then : otherwise;
      };
      const Triple<D> P{if_sticks(stick.x, slip.x), if_sticks(stick.y, slip.y), if_sticks(stick.z, slip.z)};
      // slip without a direction, or one that jams
      const D slips_well = lanes::smaller(gain, speed_t - 1e-12 * lanes::absolute(u_n));
      other = lanes::larger(if_sticks(-1.0 - overlap, -slips_well), other);

      // work_lost
      D lost{};
      lost -= P.x * (u.x + 0.5 * (K.xx * P.x + K.xy * P.y + K.xz * P.z));
      lost -= P.y * (u.y + 0.5 * (K.yx * P.x + K.yy * P.y + K.yz * P.z));
      lost -= P.z * (u.z + 0.5 * (K.zx * P.x + K.zy * P.y + K.zz * P.z));
      lanes::store(hit.lost + l, lost);
      lanes::store(hit.is_hit + l, is_hit);
      hit.impulse.store(l, P);

      // apply_impulse
      const Triple<D> torque = arm.cross(P);
      const D about_axis = (species.inverse.par - species.inverse.perp) * torque.dot(director);
      const Triple<D> more = lanes::all<W>(species.inverse.mass) * P;
      const Triple<D> turns = lanes::all<W>(species.inverse.perp) * torque + about_axis * director;
      const auto add = [&](const D& before, const D& change) __attribute__((always_inline)) {
        return is_hit > 0.0 ? before + change : before;
      };
      velocity = {add(velocity.x, more.x), add(velocity.y, more.y), add(velocity.z, more.z)};
      angular_velocity = {add(angular_velocity.x, turns.x), add(angular_velocity.y, turns.y),
                          add(angular_velocity.z, turns.z)};
    };
    if (rules.has_base) meet_plate({1.0, plates.base, rules.plates.velocity(plates), species.base}, hits.of_plate[0]);
    if (rules.has_lid) meet_plate({-1.0, plates.lid, rules.plates.lid_velocity(plates), species.lid}, hits.of_plate[1]);
    hits.velocity.store(l, velocity);
    hits.angular_velocity.store(l, angular_velocity);
    lanes::store(hits.is_other + l, other);
  }
};

void PlateHits::count(int lane, const Vec3& base_velocity, const Vec3& lid_velocity, Counters& counters) const {
  for (int plate = 0; plate < 2; ++plate) {
    if (!meets(lane, plate)) continue;
    const OfPlate& hit = of_plate[plate];
    counters.max_overlap_rod_plate = std::max(counters.max_overlap_rod_plate, hit.overlap[lane]);
    if (!is_hit(lane, plate)) continue;
    ++(plate == 0 ? counters.impulses_rod_base : counters.impulses_rod_lid);
    counters.ledger.lost_surfaces.add(hit.lost[lane]);
    const Vec3 impulse(hit.impulse.x[lane], hit.impulse.y[lane], hit.impulse.z[lane]);
    counters.ledger.given.add(impulse.dot(plate == 0 ? base_velocity : lid_velocity));
    for (std::size_t c = 0; c < 3; ++c) counters.ledger.momentum[c].add(impulse[static_cast<Eigen::Index>(c)]);
  }
}

void PlateHits::get_before(int lane, RodAtTick& rod) const {
  rod.changed = rod.displaced = rod.hit_again = false;
  position.get(lane, rod.pose.position);
  director.get(lane, rod.pose.director);
  rod.has_motion = meets(lane, 0) || meets(lane, 1);
  if (!rod.has_motion) return;
  velocity.get(lane, rod.motion.velocity);
  angular_velocity.get(lane, rod.motion.angular_velocity);
}

void PlateHits::get(int lane, RodAtTick& rod) const {
  get_before(lane, rod);
  for (int plate = 0; plate < 2; ++plate) {
    if (is_hit(lane, plate)) rod.note_hit();
  }
}

BeadsInPlates PlateHits::beads(int lane) const {
  BeadsInPlates beads;
  for (std::size_t plate = 0; plate < 2; ++plate) {
    const OfPlate& hit = of_plate[plate];
    beads.bead[plate] = hit.overlap[lane] > 0 ? static_cast<int>(hit.bead[lane]) : -1;
    beads.overlap[plate] = hit.overlap[lane];
  }
  return beads;
}

/// Whether the lanes give impulses as these plates do to rods of a species.
bool are_usual(const TickRules& rules, const SpeciesMechanics& species) {
  const auto is_usual = [](const ContactParameters& contact) {
    return contact.has_friction() && !contact.has_restitution_speed();
  };
  return (!rules.has_base || is_usual(species.base)) && (!rules.has_lid || is_usual(species.lid)) &&
         rules.impulse == &newton_coulomb_impulse && !rules.impacts_at_instant && !species.has_rotational_noise() &&
         !rules.rest.matters();
}

}  // namespace

bool lanes_know(const System& system, std::span<const Effect> effects) {
  const auto is_known = [](const Effect& effect) { return std::ranges::count(kKnownEffects, effect.name) > 0; };
  for (const Effect& effect : effects) {
    if (effect.is_on(system) && !is_known(effect)) return false;
  }
  return true;
}

LeftByLanes meet_plates_in_lanes(std::span<const int> rods, const std::vector<Flight>& flights,
                                 std::vector<RodAtTick>& at_tick, const PlateState& plates, Tick now,
                                 const TickRules& rules, Counters& counters) {
  const int n = static_cast<int>(rods.size());
  thread_local FlightLanes in{};  // lanes beyond n hold rods of before, which count for nothing
  alignas(64) double since[kDoubleLanes]{};
  for (int lane = 0; lane < n; ++lane) {
    const Flight& flight = flights[rods[lane]];
    in.set(lane, flight);
    since[lane] = static_cast<double>(now - flight.since) * rules.dt;
  }
  PlateHits hits;
  for (PlateHits::OfPlate& of_plate : hits.of_plate) std::fill_n(of_plate.overlap, kDoubleLanes, 0.0);
  const SpeciesMechanics& species = rules.species_of(rods.front());
  const bool gives_impulses = are_usual(rules, species);
  const Vec3 base_velocity = rules.plates.velocity(plates);
  const Vec3 lid_velocity = rules.plates.lid_velocity(plates);
  if (gives_impulses) {
    lanes::with_widest_doubles(PlateHitKernel<true>{species, rules, plates, in, since, n, hits});
  } else {
    lanes::with_widest_doubles(PlateHitKernel<false>{species, rules, plates, in, since, n, hits});
  }
  LeftByLanes left;
  left.all = left.hits = 0;
  for (int lane = 0; lane < n; ++lane) {
    RodAtTick& rod = at_tick[rods[lane]];
    if (!hits.is_known(lane)) {
      left.all |= 1U << lane;
    } else if (gives_impulses) {
      hits.get(lane, rod);
      hits.count(lane, base_velocity, lid_velocity, counters);
    } else {
      hits.get_before(lane, rod);
      if (!rod.has_motion) continue;
      left.hits |= 1U << lane;
      left.beads[static_cast<std::size_t>(lane)] = hits.beads(lane);
    }
  }
  return left;
}

}  // namespace shaken
