#include "sim/tick/surface_impacts.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <string>
#include <vector>

#include "sim/motion/post_contacts.h"
#include "sim/motion/side_walls.h"
#include "sim/tick/impact.h"
#include "sim/tick/rotational_noise.h"

namespace shaken {
namespace {

/// A plate or a wall where it is about to hit a bead.
struct Surface {
  Vec3 normal;    ///< away from it
  Vec3 velocity;  ///< [mm/s]
  const ContactParameters& contact;
  double rest_speed;  ///< at which the bead must leave it at least [mm/s]
};

/// Model of a bead at rest: it must leave the surface at the rest speed r, as if the surface rose at the speed s with
/// r = s - e (u_n - s). The law then gives one impulse, whose friction is that of all the weight that it carries.
impact::Impulse impulse_with_friction(const Surface& surface, const Vec3& u, const Mat3& K, ImpulseFunction law) {
  impact::Impulse impulse{Vec3::Zero(), 0};
  if (!(surface.rest_speed > 0)) {
    if (u.dot(surface.normal) < 0) impulse.P = law(K, surface.normal, u, surface.contact);
  } else {
    const double u_n = u.dot(surface.normal);
    const double e = restitution_at(surface.contact, std::max(0.0, -u_n));
    const double rise = std::max(0.0, (surface.rest_speed + e * u_n) / (1.0 + e));
    impulse.P = law(K, surface.normal, u - rise * surface.normal, surface.contact);
    // of a law whose restitution is not that of the velocity some is lacking
    const double lacking = surface.rest_speed - surface.normal.dot(u + K * impulse.P);
    if (lacking > 0) impulse.P += (lacking / surface.normal.dot(K * surface.normal)) * surface.normal;
  }
  impulse.lost = impact::work_lost(impulse.P, u, K);
  return impulse;
}

impact::Impulse impulse_without_friction(const Surface& surface, const Vec3& u, double compliance) {
  const double u_n = u.dot(surface.normal);
  if (surface.rest_speed > -restitution_at(surface.contact, -u_n) * u_n) {
    const double p = (surface.rest_speed - u_n) / compliance;
    return {p * surface.normal, -p * (u_n + 0.5 * p * compliance)};
  }
  return impact::frictionless(surface.normal, u, compliance, surface.contact);
}

/// Gives the bead an impulse if it approaches the surface.
[[gnu::always_inline]] inline bool collide(const impact::Bead& bead, const Surface& surface, const TickRules& rules,
                                           Ledger& ledger) {
  Vec3 u = bead.velocity();
  u -= surface.velocity;
  if (!(u.dot(surface.normal) < surface.rest_speed)) return false;
  impact::Impulse impulse;
  if (surface.contact.has_friction()) {
    impulse = impulse_with_friction(surface, u, bead.compliance(), rules.impulse);
    bead.apply(impulse.P);
  } else {
    impulse = impulse_without_friction(surface, u, bead.compliance_along(surface.normal));
    bead.apply_along_normal(impulse.P);
  }
  ledger.lost_surfaces.add(impulse.lost);
  ledger.given.add(impulse.P.dot(surface.velocity));
  for (std::size_t c = 0; c < 3; ++c) ledger.momentum[c].add(impulse.P[static_cast<Eigen::Index>(c)]);
  return true;
}

/// The lid's normal points down; what stands upright moves with the base.
bool is_of_lid(const Vec3& normal) { return normal.z() < 0; }

double upwards(const PlateState& plates, const Vec3& normal) {
  return is_of_lid(normal) ? plates.lid_velocity : plates.velocity;
}

Vec3 velocity_of(const Vec3& normal, const PlateState& plates, const TickRules& rules) {
  return is_of_lid(normal) ? rules.plates.lid_velocity(plates) : rules.plates.velocity(plates);
}

/// The bead `b` of a rod against a plate or wall that it overlaps, at tick `now`. Returns whether it
/// approached. Flattened: or else its 3 x 3 matrices are copied by a call: 2.5 % of all instructions (callgrind).
[[gnu::flatten]] bool collide_with(const Vec3& normal, int b, double overlap, const ContactParameters& contact,
                                   RodAtTick& rod, const SpeciesMechanics& species, const PlateState& plates, Tick now,
                                   const TickRules& rules, Counters& counters) {
  const double offset = species.bead_offset[b];
  const double radius = species.bead_radius[b];
  const auto bead = [&] { return impact::Bead{species, rod, offset, offset * rod.pose.director - radius * normal}; };
  const bool rests = rules.rest.matters() && contact.restitution < 1 && normal.z() > 0;
  const double rest_speed = rests ? rules.rest.at(overlap) : 0.0;
  if (rules.system.has_impacts_at_instant()) {
    const double speed = -(bead().velocity().dot(normal) - upwards(plates, normal) * normal.z());
    if (const auto ago = impact::time_since_touch(overlap, speed, rules.dt)) {
      impact::fly(rod, -*ago, species, rules.gravity);
      const Surface surface{normal, velocity_of(normal, rules.plates.before(now, *ago), rules), contact, rest_speed};
      const bool approached = collide(bead(), surface, rules, counters.ledger);
      impact::fly(rod, *ago, species, rules.gravity);
      if (approached) {
        rod.displaced = true;
        ++counters.impacts_at_instant;
        return true;
      }
    }
  }
  return collide(bead(), {normal, velocity_of(normal, plates, rules), contact, rest_speed}, rules, counters.ledger);
}

/// Looks for the deepest of a rod's beads in its surfaces. No bead order and no sign of the director has a say: two of
/// the same depth come by where they lie, so a rod turned end for end meets its surfaces in the same way.
class Deepest {
 public:
  explicit Deepest(const Vec3& director) : director_(director) {}

  void see(int item, double offset, double overlap) {
    if (!(overlap > 0)) return;
    ++n_overlapping_;
    if (overlap < overlap_ || (overlap == overlap_ && !lies_before(offset))) return;
    item_ = item;
    offset_ = offset;
    overlap_ = overlap;
  }
  bool found() const { return item_ >= 0; }
  bool is_only_one() const { return n_overlapping_ == 1; }
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
  int n_overlapping_ = 0;
  double offset_ = 0;
  double overlap_ = 0;
};

NumericalTrouble too_deep(Tick now, int index, int bead, double overlap, const char* where) {
  return {now, {index}, "bead " + std::to_string(bead) + " is " + std::to_string(overlap) + " mm deep in the " + where};
}

/// A rod at its surfaces, at tick `now`.
struct Visit {
  int index;
  RodAtTick& rod;
  const Flight& flight;
  const PlateState& plates;
  Tick now;
  const TickRules& rules;
  Counters& counters;
  const SpeciesMechanics& species = rules.species_of(index);
};

/// A rod's visit to the plates.
struct PlateVisit : Visit {
  int n_hits = 0;

  /// What a plate does to a bead that is in it. `side`: +1: base, pushes up; -1: lid, pushes down.
  void meet(double side, int bead, double overlap) {
    evaluate_motion(rod, flight, now, species, rules);
    counters.max_overlap_rod_surface = std::max(counters.max_overlap_rod_surface, overlap);
    double speed = 0;  // of the hit
    if (species.has_rotational_noise()) {
      const Vec3 arm = species.bead_offset[bead] * rod.pose.director - species.bead_radius[bead] * side * Vec3::UnitZ();
      speed = std::abs(point_velocity(rod.motion, arm).z() - (side > 0 ? plates.velocity : plates.lid_velocity));
    }
    const ContactParameters& contact = side > 0 ? species.base : species.lid;
    if (!collide_with(Vec3(0, 0, side), bead, overlap, contact, rod, species, plates, now, rules, counters)) return;
    ++(side > 0 ? counters.impulses_rod_base : counters.impulses_rod_lid);
    if (species.has_rotational_noise()) turn_at_random(index, n_hits, rod, species, speed, now, rules, counters);
    ++n_hits;
  }

  /// One plate or both are out of reach of most rods.
  bool is_out_of_reach(double side) const {
    const double extent =
        std::max(species.mid_radius, species.end_radius + species.half_length * std::abs(rod.pose.director.z()));
    return side > 0 ? rod.pose.position.z() - extent >= plates.base : rod.pose.position.z() + extent <= plates.lid;
  }

  /// The beads that a plate meets, the deepest first.
  std::optional<NumericalTrouble> meet_all(double side) {
    const double plate = side > 0 ? plates.base : plates.lid;
    std::bitset<kMostBeads> met;
    for (bool done = false; !done;) {  // one bead after the other, the deepest first, as the rod is by then
      Deepest deepest(rod.pose.director);
      for (const int bead : species.outer_beads) {
        const double offset = species.bead_offset[bead];
        const double above = side * (rod.pose.position.z() + offset * rod.pose.director.z() - plate);
        if (!met[bead]) deepest.see(bead, offset, species.bead_radius[bead] - above);
      }
      if (!deepest.found()) break;
      done = pose_stays(rules) && deepest.is_only_one();
      const int bead = deepest.item();
      const double overlap = deepest.overlap();
      met.set(bead);
      if (overlap > kMaxOverlapFraction * species.bead_radius[bead])
        return too_deep(now, index, bead, overlap, side > 0 ? "base" : "lid");
      meet(side, bead, overlap);
    }
    return {};
  }

  /// Whether a rod stays where it is, whatever impulses it gets: noise changes its motion only.
  static bool pose_stays(const TickRules& rules) { return !rules.system.has_impacts_at_instant(); }
};

std::optional<NumericalTrouble> meet_plates(PlateVisit visit) {
  for (const double side : {1.0, -1.0}) {
    if (!(side > 0 ? visit.rules.system.base : visit.rules.system.lid) || visit.is_out_of_reach(side)) continue;
    if (auto trouble = visit.meet_all(side)) return trouble;
  }
  return {};
}

/// A rod's visit to what stands upright: side walls, posts.
struct UprightVisit : Visit {
  /// The surfaces of one kind, which have the numbers 0 .. `n` - 1: `see(bead's centre, its radius, note)` calls
  /// note(number, as seen) of those that the bead may touch. No overlap may be more than a part of `thinnest` [mm].
  template <class See>
  std::optional<NumericalTrouble> meet(int n, const See& see, double thinnest, const ContactParameters& contact,
                                       const char* name, std::int64_t& impulses) {
    std::vector<int> met;  // of each bead its surfaces, in one number
    while (true) {
      Deepest deepest(rod.pose.director);
      for (int bead = 0; bead < species.n_beads(); ++bead) {
        see_from(bead, see, [&](int surface, const WallSeen& seen) {
          const int item = n * bead + surface;
          if (std::find(met.begin(), met.end(), item) != met.end()) return;
          deepest.see(item, species.bead_offset[bead], species.bead_radius[bead] - seen.distance);
        });
      }
      if (!deepest.found()) return {};
      const int bead = deepest.item() / n;
      const double overlap = deepest.overlap();
      met.push_back(deepest.item());
      if (overlap > kMaxOverlapFraction * std::min(thinnest, species.bead_radius[bead]))
        return too_deep(now, index, bead, overlap, name);
      evaluate_motion(rod, flight, now, species, rules);
      counters.max_overlap_rod_surface = std::max(counters.max_overlap_rod_surface, overlap);
      Vec3 normal = Vec3::Zero();
      see_from(bead, see, [&](int surface, const WallSeen& seen) {
        if (n * bead + surface == deepest.item()) normal = seen.normal;
      });
      if (collide_with(normal, bead, overlap, contact, rod, species, plates, now, rules, counters)) ++impulses;
    }
  }

 private:
  template <class See, class Note>
  void see_from(int bead, const See& see, const Note& note) const {
    see(Vec3(rod.pose.position + species.bead_offset[bead] * rod.pose.director), species.bead_radius[bead], note);
  }
};

std::optional<NumericalTrouble> meet_side_walls(UprightVisit& visit) {
  const SideWalls& walls = *visit.rules.system.walls;
  const Box& box = visit.rules.box;
  if (!may_touch_walls(walls, box, visit.species, visit.rod.pose)) return {};
  const auto see = [&](const Vec3& center, double radius, const auto& note) {
    const WallsSeen seen = see_walls(walls, box, center, radius);
    for (int w = 0; w < seen.n; ++w) note(w, seen.walls[static_cast<std::size_t>(w)]);
  };
  return visit.meet(WallsSeen::kMost, see, INFINITY, visit.species.wall, "side wall", visit.counters.impulses_rod_wall);
}

std::optional<NumericalTrouble> meet_posts(UprightVisit& visit) {
  const PostGrid& posts = *visit.rules.posts;
  if (!may_touch_posts(posts, visit.species, visit.rod.pose)) return {};
  const auto see = [&](const Vec3& center, double radius, const auto& note) {
    posts.for_each_within(center.head<2>(), posts.radius() + radius,
                          [&](int post, const Vec2& axis) { note(post, see_post(axis, posts.radius(), center)); });
  };
  return visit.meet(posts.n_posts(), see, posts.radius(), visit.species.post, "post", visit.counters.impulses_rod_post);
}

}  // namespace

std::optional<NumericalTrouble> meet_uprights(int index, RodAtTick& rod, const Flight& flight, const PlateState& plates,
                                              Tick now, const TickRules& rules, Counters& counters) {
  UprightVisit visit{{index, rod, flight, plates, now, rules, counters}};
  if (rules.system.walls) {
    if (auto trouble = meet_side_walls(visit)) return trouble;
  }
  if (rules.posts) return meet_posts(visit);
  return {};
}

std::optional<NumericalTrouble> meet_surfaces(int index, RodAtTick& rod, const Flight& flight, const PlateState& plates,
                                              Tick now, const TickRules& rules, Counters& counters) {
  if (rules.system.base || rules.system.lid) {
    if (auto trouble = meet_plates({{index, rod, flight, plates, now, rules, counters}})) return trouble;
  }
  if (rules.has_uprights()) return meet_uprights(index, rod, flight, plates, now, rules, counters);
  return {};
}

}  // namespace shaken
