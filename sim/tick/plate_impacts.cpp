#include "sim/tick/plate_impacts.h"

#include <algorithm>
#include <string_view>

#include "sim/contact/impact_process_lanes.h"
#include "sim/motion/flight_lanes.h"
#include "sim/tick/rotational_noise.h"

namespace shaken {
namespace {

/// The effects that the lanes know. Those between rods, at side walls and at posts take place elsewhere.
// clang-format off
constexpr std::string_view kKnownEffects[] = {
    "gravity", "vibration", "tilt", "species", "polydispersity", "taper", "spin", "rod_rod_collisions",
    "rod_rod_friction", "rod_rod_restitution", "rod_base_collisions", "rod_base_friction", "rod_base_restitution",
    "rod_lid_collisions", "rod_lid_friction", "rod_lid_restitution", "side_walls", "side_wall_friction", "posts",
    "post_friction", "rotational_noise", "impacts_at_instant", "horizontal_vibration", "second_vibration",
    "lid_motion", "inclination", "restitution_speed", "species_contacts"};
// clang-format on

using lanes::ComplianceOf;
using lanes::Doubles;
using lanes::FlightLanes;
using lanes::ImpulseOf;
using lanes::kDoubleLanes;
using lanes::MotionOf;
using lanes::PoseOf;
using lanes::Triple;
using lanes::TripleLanes;
using lanes::where_positive;

/// What the plates do to several rods at a tick.
struct PlateHits {
  /// What one plate does.
  struct OfPlate {
    TripleLanes impulse;
    alignas(64) double lost[kDoubleLanes];     ///< energy
    alignas(64) double given[kDoubleLanes];    ///< by the plate
    alignas(64) double noise[kDoubleLanes];    ///< energy that rotational noise gives
    alignas(64) double overlap[kDoubleLanes];  ///< of the bead in the plate; 0: none
    alignas(64) double is_hit[kDoubleLanes];   ///< > 0: yes, where there is an overlap
    alignas(64) double ago[kDoubleLanes];      ///< > 0: the hit took place so long before the tick [s]
  };
  TripleLanes position, director, velocity, angular_velocity;  ///< of the rods after the hits
  TripleLanes flight_position, flight_director;                ///< before them, where hits displace rods
  OfPlate of_plate[2];                                         ///< base, lid
  alignas(64) double is_unknown[kDoubleLanes];                 ///< >= 0: what happens is not known here
  bool has_noise, are_at_instant;

  bool is_known(int lane) const { return is_unknown[lane] < 0; }
  bool meets(int lane, int plate) const { return of_plate[plate].overlap[lane] > 0; }
  bool is_hit(int lane, int plate) const { return meets(lane, plate) && of_plate[plate].is_hit[lane] > 0; }

  /// Counts the lane's hits.
  void count(int lane, Counters& counters) const;
  /// The lane's rod after them; its motion only where a bead is in a plate.
  void get(int lane, RodAtTick& rod) const;
  void get_flight_pose(int lane, Pose& pose) const;
};

/// Where a rod meets a plate.
struct PlateMet {
  double side;    ///< +1: base, -1: lid
  double height;  ///< [mm]
  Vec3 velocity;  ///< [mm/s]
  const ContactParameters& contact;
};

/// Several rods during one tick. As in double_lanes.h, the sign of a number tells whether a condition holds.
template <class D>
struct RodsOf {
  PoseOf<D> pose;
  MotionOf<D> motion;
  D unknown;  ///< >= 0: what happens to them is not known here
  D is_hit;   ///< > 0: a plate has hit them; for noise

  /// From now on not known where the condition is >= 0. Where it is no number, `larger` passes it over: what comes
  /// after a hit that is not known may be none.
  SHAKEN_INLINE void note_unknown(const D& condition) { unknown = lanes::larger(condition, unknown); }
};

/// The bead of each rod that is in a plate.
template <class D>
struct BeadsOf {
  D n{};        ///< how many there are; the others' sizes are of one of them
  D overlap{};  ///< 0: there is none
  D offset{};
  D radius = D{} + 1.0;
};

/// Beads where a plate hits them.
template <class D>
struct ContactsOf {
  Triple<D> plate_velocity, normal, arm;
  Triple<D> u;  ///< velocity relative to the plate [mm/s]
  D u_n;        ///< of that along the normal
};

template <class D>
SHAKEN_INLINE Triple<D> in_lanes(const Vec3& v) {
  return {D{} + v.x(), D{} + v.y(), D{} + v.z()};
}

/// What surface_impacts.cpp does for one rod, for W of them at once and equal to the last bit. `meet` brings rods to
/// the tick; `meet_plate` finds the bead in each plate, where it meets it and how fast, gives the impulse (at the
/// instant of contact, if scenes ask for that: rods fly back to it and on again) and the noise. Nothing branches by
/// rod: both sides are computed and one is chosen by sign, and what is rare (two beads in a plate, a large turn) is
/// only noted, as unknown; its rods are done one by one.
/// `kIsUsual`: plates act as `are_usual` says, and nothing rarer need be asked for. One kernel for all is too long for
/// the usual hits, which it makes half again as slow.
template <bool kIsUsual>
struct PlateHitKernel {
  const SpeciesMechanics& species;
  const TickRules& rules;
  const PlateMet (&plates_met)[2];  ///< base, lid
  Tick now;
  const FlightLanes& flights;
  const double* since;  ///< how long each has flown [s]
  const double* sign;   ///< of its noise
  int n;
  PlateHits& hits;

  template <int W>
  SHAKEN_INLINE void run() const {
    for (int l = 0; l < n; l += W) meet<W>(l);
  }

  template <int W>
  SHAKEN_INLINE void meet(int l) const {
    using D = Doubles<W>;
    const lanes::FlightOf<D> flight = flights.load<W>(l);
    const D tau = lanes::load<W>(since + l);
    RodsOf<D> rods;
    rods.pose = pose_after(flight, tau, rules.gravity);
    rods.motion = motion_after(flight, tau, rules.gravity, rods.pose.director, species.inertia_ratio);
    rods.unknown = lanes::absolute(flight.rate * tau) - kLargestSmallAngle;  // a large turn
    rods.is_hit = D{} - 1.0;
    if (is_at_instant()) {
      hits.flight_position.store(l, rods.pose.position);
      hits.flight_director.store(l, rods.pose.director);
    }
    if constexpr (kIsUsual) {  // a copy for each plate, in which its side is a constant
      const auto met = [&](double side, int k) __attribute__((always_inline)) {
        const PlateMet& plate = plates_met[k];
        meet_plate<W>(l, PlateMet{side, plate.height, plate.velocity, plate.contact}, rods, hits.of_plate[k]);
      };
      if (rules.system.base) met(1.0, 0);
      if (rules.system.lid) met(-1.0, 1);
    } else {  // one copy: it must fit into the cache
      for (int k = rules.system.base ? 0 : 1; k < (rules.system.lid ? 2 : 1); ++k) {
        meet_plate<W>(l, plates_met[k], rods, hits.of_plate[k]);
      }
    }
    hits.position.store(l, rods.pose.position);
    hits.director.store(l, rods.pose.director);
    hits.velocity.store(l, rods.motion.velocity);
    hits.angular_velocity.store(l, rods.motion.angular_velocity);
    lanes::store(hits.is_unknown + l, rods.unknown);
  }

  template <int W>
  SHAKEN_INLINE void meet_plate(int l, const PlateMet& plate, RodsOf<Doubles<W>>& rods, PlateHits::OfPlate& hit) const {
    using D = Doubles<W>;
    const BeadsOf<D> beads = beads_in(plate, rods.pose);
    rods.note_unknown(D(beads.n - 1.5));  // several beads in one plate
    rods.note_unknown(D(beads.overlap - kMaxOverlapFraction * beads.radius));
    lanes::store(hit.overlap + l, beads.overlap);
    bool is_met = false;
    for (int lane = 0; lane < W; ++lane) is_met |= beads.overlap[lane] > 0;
    if (!is_met) return;  // as a rule a vector of rods meets one plate, where they rest

    D rest_speed{};
    if (rests(plate)) rest_speed = rules.rest.half_fall + rules.rest.rise_rate * beads.overlap;
    ContactsOf<D> contacts = contacts_of(plate, beads, in_lanes<D>(plate.velocity), rods);
    const D is_hit = lanes::smaller(beads.overlap, D(rest_speed - contacts.u_n));
    const D speed = lanes::absolute(contacts.u_n);
    D ago{};
    if (is_at_instant()) {
      ago = time_since_touch(beads, D(-contacts.u_n));
      fly(D(-ago), rods);
      contacts = contacts_of(plate, beads, velocities_before<W>(plate, ago), rods);
      // a rod that recedes at that instant
      rods.note_unknown(where_positive(ago, D(contacts.u_n - rest_speed), D(-1.0 - ago)));
    }
    give_impulse<W>(l, plate, beads, contacts, rest_speed, is_hit, rods, hit);
    if (is_at_instant()) {
      fly(ago, rods);
      lanes::store(hit.ago + l, ago);
      rods.note_unknown(others_overlap(plate, beads, rods.pose));
    }
    lanes::store(hit.is_hit + l, is_hit);
    if (has_noise()) turn_at_random<W>(l, speed, is_hit, rods, hit);
  }

  /// As meet_plates finds them.
  template <class D>
  SHAKEN_INLINE BeadsOf<D> beads_in(const PlateMet& plate, const PoseOf<D>& pose) const {
    // as it passes over rods that are out of reach
    const D at_ends = species.end_radius + species.half_length * lanes::absolute(pose.director.z);
    const D extent = lanes::larger(D(D{} + species.mid_radius), at_ends);
    const D within_reach = plate.side * plate.height - plate.side * (pose.position.z - plate.side * extent);
    BeadsOf<D> beads;
    for (const int bead : species.outer_beads) {
      const double r = species.bead_radius[bead];
      const D above = plate.side * (pose.position.z + species.bead_offset[bead] * pose.director.z - plate.height);
      const D deep = r - above;
      const D overlaps = lanes::smaller(deep, within_reach);
      beads.n = where_positive(overlaps, D(beads.n + 1.0), beads.n);
      beads.offset = where_positive(overlaps, D(D{} + species.bead_offset[bead]), beads.offset);
      beads.radius = where_positive(overlaps, D(D{} + r), beads.radius);
      beads.overlap = where_positive(overlaps, deep, beads.overlap);
    }
    return beads;
  }

  /// > 0: there is another bead in the plate beside the one that is known.
  template <class D>
  SHAKEN_INLINE D others_overlap(const PlateMet& plate, const BeadsOf<D>& known, const PoseOf<D>& pose) const {
    D deepest = D{} - 1.0;
    for (const int bead : species.outer_beads) {
      const double offset = species.bead_offset[bead];
      const D above = plate.side * (pose.position.z + offset * pose.director.z - plate.height);
      const D deep = species.bead_radius[bead] - above;
      deepest = where_positive(lanes::absolute(known.offset - offset), lanes::larger(deep, deepest), deepest);
    }
    return where_positive(known.overlap, deepest, D(-1.0 - known.overlap));
  }

  template <class D>
  SHAKEN_INLINE ContactsOf<D> contacts_of(const PlateMet& plate, const BeadsOf<D>& beads, const Triple<D>& velocity,
                                          const RodsOf<D>& rods) const {
    ContactsOf<D> contacts;
    contacts.plate_velocity = velocity;
    contacts.normal = {D{}, D{}, D{} + plate.side};
    contacts.arm = beads.offset * rods.pose.director - beads.radius * contacts.normal;
    contacts.u = rods.motion.velocity + rods.motion.angular_velocity.cross(contacts.arm);
    contacts.u.z -= velocity.z;
    if (rules.system.has_horizontal_vibration()) {
      contacts.u.x -= velocity.x;
      contacts.u.y -= velocity.y;
    }
    contacts.u_n = contacts.u.dot(contacts.normal);
    return contacts;
  }

  bool is_at_instant() const { return !kIsUsual && rules.system.has_impacts_at_instant(); }
  bool has_noise() const { return !kIsUsual && species.has_rotational_noise(); }
  bool rests(const PlateMet& plate) const {
    return !kIsUsual && rules.rest.matters() && plate.contact.restitution < 1 && plate.side > 0;
  }

  /// As in tick/impact.h; 0: none within this tick [s].
  template <class D>
  SHAKEN_INLINE D time_since_touch(const BeadsOf<D>& beads, const D& speed) const {
    const D within = beads.overlap > 0.0 ? speed * rules.dt - beads.overlap : -1.0 - beads.overlap;
    return within >= 0.0 ? beads.overlap / speed : D{};
  }

  /// impact::fly, of rods whose time is not 0. Not known here: a large turn, or none.
  template <class D>
  SHAKEN_INLINE void fly(const D& seconds, RodsOf<D>& rods) const {
    const lanes::FlightOf<D> flight = lanes::flight_of(rods.pose, rods.motion, species.inertia_ratio);
    const PoseOf<D> pose = pose_after(flight, seconds, rules.gravity);
    const MotionOf<D> motion = motion_after(flight, seconds, rules.gravity, pose.director, species.inertia_ratio);
    const D flies = lanes::absolute(seconds);
    const D turn = lanes::absolute(flight.rate * seconds);
    rods.note_unknown(
        where_positive(flies, lanes::larger(D(turn - kLargestSmallAngle), D(-flight.rate)), D(-1.0 - flies)));
    rods.pose.position = where_positive(flies, pose.position, rods.pose.position);
    rods.pose.director = where_positive(flies, pose.director, rods.pose.director);
    rods.motion.velocity = where_positive(flies, motion.velocity, rods.motion.velocity);
    rods.motion.angular_velocity = where_positive(flies, motion.angular_velocity, rods.motion.angular_velocity);
  }

  /// The plate's velocity so long before the tick.
  template <int W>
  SHAKEN_INLINE Triple<Doubles<W>> velocities_before(const PlateMet& plate, const Doubles<W>& ago) const {
    TripleLanes velocities;
    for (int lane = 0; lane < W; ++lane)
      velocities.set(lane, ago[lane] > 0 ? velocity_before(plate, ago[lane]) : plate.velocity);
    return velocities.load<W>(0);
  }
  Vec3 velocity_before(const PlateMet& plate, double ago) const {
    const PlateState then = rules.plates.before(now, ago);
    return plate.side > 0 ? rules.plates.velocity(then) : rules.plates.lid_velocity(then);
  }

  /// What impulses do to rods.
  template <class D>
  struct EffectOf {
    Triple<D> P;      ///< impulse [mg mm/s]
    Triple<D> turns;  ///< change of the angular velocity [rad/s]
    D lost;           ///< energy [pJ]
  };

  /// `collide` of surface_impacts.cpp, of the rods that are hit.
  template <int W>
  SHAKEN_INLINE void give_impulse(int l, const PlateMet& plate, const BeadsOf<Doubles<W>>& beads,
                                  const ContactsOf<Doubles<W>>& contacts, const Doubles<W>& rest_speed,
                                  const Doubles<W>& is_hit, RodsOf<Doubles<W>>& rods, PlateHits::OfPlate& hit) const {
    using D = Doubles<W>;
    EffectOf<D> effect;
    if (kIsUsual || plate.contact.has_friction()) {
      const ComplianceOf<D> K = lanes::point_compliance(species.inverse, rods.pose.director, contacts.arm);
      const ImpulseOf<D> impulse = impulse_with_friction(plate, contacts, K, rest_speed);
      rods.note_unknown(where_positive(is_hit, impulse.unknown, D(-1.0 - beads.overlap)));
      effect = effect_of<W>(impulse.P, contacts, K, rods.pose.director);
    } else {
      effect = effect_without_friction(plate, beads, contacts, rest_speed, rods.pose.director);
    }
    const Triple<D> more = lanes::all<W>(species.inverse.mass) * effect.P;
    MotionOf<D>& motion = rods.motion;
    motion.velocity = where_positive(is_hit, motion.velocity + more, motion.velocity);
    motion.angular_velocity = where_positive(is_hit, motion.angular_velocity + effect.turns, motion.angular_velocity);
    hit.impulse.store(l, effect.P);
    lanes::store(hit.lost + l, effect.lost);
    lanes::store(hit.given + l, effect.P.dot(contacts.plate_velocity));
  }

  /// impact::work_lost and apply_impulse.
  template <int W, class D>
  SHAKEN_INLINE EffectOf<D> effect_of(const Triple<D>& P, const ContactsOf<D>& contacts, const ComplianceOf<D>& K,
                                      const Triple<D>& director) const {
    const Triple<D>& u = contacts.u;
    D lost{};
    lost -= P.x * (u.x + 0.5 * (K.xx * P.x + K.xy * P.y + K.xz * P.z));
    lost -= P.y * (u.y + 0.5 * (K.yx * P.x + K.yy * P.y + K.yz * P.z));
    lost -= P.z * (u.z + 0.5 * (K.zx * P.x + K.zy * P.y + K.zz * P.z));
    const Triple<D> torque = contacts.arm.cross(P);
    const D about_axis = (species.inverse.par - species.inverse.perp) * torque.dot(director);
    return {P, lanes::all<W>(species.inverse.perp) * torque + about_axis * director, lost};
  }

  /// normal_compliance, impulse_without_friction and apply_normal_impulse.
  template <class D>
  SHAKEN_INLINE EffectOf<D> effect_without_friction(const PlateMet& plate, const BeadsOf<D>& beads,
                                                    const ContactsOf<D>& contacts, const D& rest_speed,
                                                    const Triple<D>& director) const {
    const D along = director.dot(contacts.normal);
    const D compliance =
        species.inverse.mass + species.inverse.perp * (beads.offset * beads.offset * (1.0 - along * along));
    const D e = lanes::restitution_at(plate.contact, D(-contacts.u_n));
    const D bounced = -(1.0 + e) * contacts.u_n / compliance;
    const D risen = (rest_speed - contacts.u_n) / compliance;
    const D p = where_positive(D(rest_speed + e * contacts.u_n), risen, bounced);
    const Triple<D> P = p * contacts.normal;
    return {P, D(species.inverse.perp * beads.offset) * director.cross(P), -p * (contacts.u_n + 0.5 * p * compliance)};
  }

  template <class D>
  SHAKEN_INLINE ImpulseOf<D> impulse_with_friction(const PlateMet& plate, const ContactsOf<D>& contacts,
                                                   const ComplianceOf<D>& K, const D& rest_speed) const {
    Triple<D> u = contacts.u;
    if (rests(plate)) {
      const D e = lanes::restitution_at(plate.contact, lanes::larger(D(-contacts.u_n), D{}));
      const D rise = lanes::larger(D((rest_speed + e * contacts.u_n) / (1.0 + e)), D{});
      u = contacts.u - rise * contacts.normal;
    }
    ImpulseOf<D> impulse = impulse_by_law(plate, contacts.normal, u, K);
    if (rests(plate)) {
      const D lacking = rest_speed - contacts.normal.dot(contacts.u + K * impulse.P);
      const Triple<D> more = D(lacking / contacts.normal.dot(K * contacts.normal)) * contacts.normal;
      impulse.P = where_positive(lacking, impulse.P + more, impulse.P);
    }
    return impulse;
  }

  template <class D>
  SHAKEN_INLINE ImpulseOf<D> impulse_by_law(const PlateMet& plate, const Triple<D>& normal, const Triple<D>& u,
                                            const ComplianceOf<D>& K) const {
    if (kIsUsual) return lanes::newton_coulomb_impulse(K, normal, u, plate.contact.friction, plate.contact.restitution);
    const D e = lanes::restitution_at(plate.contact, D(-u.dot(normal)));
    if (rules.impulse == &newton_coulomb_impulse)
      return lanes::newton_coulomb_impulse(K, normal, u, plate.contact.friction, e);
    return lanes::impulse_of_process(rules.impulse == &energetic_impulse, K, plate.side, u, plate.contact.friction, e);
  }

  /// As tick/rotational_noise.h does; the hits of both plates in one tick draw two numbers, which are not known here.
  template <int W>
  SHAKEN_INLINE void turn_at_random(int l, const Doubles<W>& speed, const Doubles<W>& is_hit, RodsOf<Doubles<W>>& rods,
                                    PlateHits::OfPlate& hit) const {
    using D = Doubles<W>;
    rods.note_unknown(where_positive(is_hit, rods.is_hit, D(D{} - 1.0)));
    const Triple<D>& director = rods.pose.director;
    Triple<D>& w = rods.motion.angular_velocity;
    const D kick = lanes::load<W>(sign + l) * species.rotational_noise * speed;
    const Triple<D> up{D{}, D{}, D{} + 1.0};
    const Triple<D> turn = kick * (up - director.z * director);
    lanes::store(hit.noise + l, D(species.inertia_perp * (w + D(D{} + 0.5) * turn).dot(turn)));
    w = where_positive(is_hit, w + turn, w);
    rods.is_hit = where_positive(is_hit, is_hit, rods.is_hit);
  }
};

void PlateHits::count(int lane, Counters& counters) const {
  for (int plate = 0; plate < 2; ++plate) {
    if (!meets(lane, plate)) continue;
    const OfPlate& hit = of_plate[plate];
    counters.max_overlap_rod_surface = std::max(counters.max_overlap_rod_surface, hit.overlap[lane]);
    if (!is_hit(lane, plate)) continue;
    ++(plate == 0 ? counters.impulses_rod_base : counters.impulses_rod_lid);
    counters.ledger.lost_surfaces.add(hit.lost[lane]);
    counters.ledger.given.add(hit.given[lane]);
    counters.ledger.momentum[0].add(hit.impulse.x[lane]);
    counters.ledger.momentum[1].add(hit.impulse.y[lane]);
    counters.ledger.momentum[2].add(hit.impulse.z[lane]);
    if (are_at_instant && hit.ago[lane] > 0) ++counters.impacts_at_instant;
    if (!has_noise) continue;
    counters.ledger.noise.add(hit.noise[lane]);
    ++counters.noise_kicks;
  }
}

void PlateHits::get(int lane, RodAtTick& rod) const {
  rod.changed = rod.displaced = false;
  position.get(lane, rod.pose.position);
  director.get(lane, rod.pose.director);
  rod.has_motion = meets(lane, 0) || meets(lane, 1);
  if (!rod.has_motion) return;
  velocity.get(lane, rod.motion.velocity);
  angular_velocity.get(lane, rod.motion.angular_velocity);
  for (int plate = 0; plate < 2; ++plate) {
    if (!is_hit(lane, plate)) continue;
    rod.changed = true;
    if (are_at_instant && of_plate[plate].ago[lane] > 0) rod.displaced = true;
  }
}

void PlateHits::get_flight_pose(int lane, Pose& pose) const {
  flight_position.get(lane, pose.position);
  flight_director.get(lane, pose.director);
}

/// Whether plates ask for nothing beside friction, by Newton's law, of rods of a species.
bool are_usual(const TickRules& rules, const SpeciesMechanics& species) {
  const auto is_usual = [](const ContactParameters& contact) {
    return contact.has_friction() && !contact.has_restitution_speed();
  };
  return (!rules.system.base || is_usual(species.base)) && (!rules.system.lid || is_usual(species.lid)) &&
         rules.impulse == &newton_coulomb_impulse && !rules.system.has_impacts_at_instant() &&
         !species.has_rotational_noise() && !rules.rest.matters();
}

/// The compiler asks for every law; one that the kernel does not compute is to return false.
bool is_in_lanes(ImpulseLaw law) {
  switch (law) {
    case ImpulseLaw::kNewton:
    case ImpulseLaw::kPoisson:
    case ImpulseLaw::kEnergetic:
      return true;
  }
  return false;
}

}  // namespace

bool lanes_know(const System& system, std::span<const Effect> effects) {
  if (!is_in_lanes(system.law)) return false;
  const auto is_known = [](const Effect& effect) { return std::ranges::count(kKnownEffects, effect.name) > 0; };
  for (const Effect& effect : effects) {
    if (effect.is_on(system) && !is_known(effect)) return false;
  }
  return true;
}

std::uint32_t meet_plates_in_lanes(std::span<const int> rods, const std::vector<Flight>& flights,
                                   std::vector<RodAtTick>& at_tick, std::vector<Pose>& flight_pose,
                                   const PlateState& plates, Tick now, const TickRules& rules, Counters& counters) {
  const int n = static_cast<int>(rods.size());
  const SpeciesMechanics& species = rules.species_of(rods.front());
  PlateHits hits;
  hits.has_noise = species.has_rotational_noise();
  hits.are_at_instant = rules.system.has_impacts_at_instant();
  for (PlateHits::OfPlate& of_plate : hits.of_plate) std::fill_n(of_plate.overlap, kDoubleLanes, 0.0);
  thread_local FlightLanes in{};  // lanes beyond n hold rods of before, which count for nothing
  alignas(64) double since[kDoubleLanes]{};
  alignas(64) double sign[kDoubleLanes]{};
  for (int lane = 0; lane < n; ++lane) {
    const Flight& flight = flights[rods[lane]];
    in.set(lane, flight);
    since[lane] = static_cast<double>(now - flight.since) * rules.dt;
    if (hits.has_noise) sign[lane] = sign_of_noise(rods[lane], 0, now, rules);
  }
  const PlateMet plates_met[2] = {{1.0, plates.base, rules.plates.velocity(plates), species.base},
                                  {-1.0, plates.lid, rules.plates.lid_velocity(plates), species.lid}};
  if (are_usual(rules, species)) {
    lanes::with_widest_doubles(PlateHitKernel<true>{species, rules, plates_met, now, in, since, sign, n, hits});
  } else {
    lanes::with_widest_doubles(PlateHitKernel<false>{species, rules, plates_met, now, in, since, sign, n, hits});
  }
  std::uint32_t unresolved = 0;
  for (int lane = 0; lane < n; ++lane) {
    if (!hits.is_known(lane)) {
      unresolved |= 1U << lane;
      continue;
    }
    hits.get(lane, at_tick[rods[lane]]);
    if (hits.are_at_instant) hits.get_flight_pose(lane, flight_pose[rods[lane]]);
    hits.count(lane, counters);
  }
  return unresolved;
}

}  // namespace shaken
