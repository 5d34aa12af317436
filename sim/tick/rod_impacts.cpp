#include "sim/tick/rod_impacts.h"

#include <algorithm>
#include <string>

#include "base/core/rng.h"
#include "sim/tick/impact.h"

namespace shaken {
namespace {

/// Gives both rods an impulse if their beads approach, which overlap by `overlap` [mm].
[[gnu::always_inline]] inline bool collide(const impact::Bead& i, const impact::Bead& j, const Vec3& normal,
                                           double overlap, const ContactParameters& contact, const TickRules& rules,
                                           Ledger& ledger) {
  const Vec3 u = j.velocity() - i.velocity();
  if (!(u.dot(normal) < 0)) return false;
  impact::Impulse impulse;
  if (contact.has_friction()) {
    const Mat3 K = i.compliance() + j.compliance();
    impulse.P = rules.impulse(K, normal, u, contact);
    impulse.lost = impact::work_lost(impulse.P, u, K);
    j.apply(impulse.P);
    i.apply(-impulse.P);
  } else {
    impulse = impact::frictionless(normal, u, i.compliance_along(normal) + j.compliance_along(normal), contact);
    j.apply_along_normal(impulse.P);
    i.apply_along_normal(-impulse.P);
  }
  ledger.lost_rod_rod.add(impulse.lost);
  const Vec3 way = i.arm - j.arm - overlap * normal;
  for (std::size_t k = 0; k < 4; ++k)
    ledger.virial[k].add(way[static_cast<Eigen::Index>(k / 2)] * impulse.P[static_cast<Eigen::Index>(k % 2)]);
  return true;
}

/// One contact. The motion of both rods must have been evaluated. Flattened as collide_with in surface_impacts.cpp.
[[gnu::flatten]] void collide(const PairContact& contact, RodAtTick& rod_i, RodAtTick& rod_j, const TickRules& rules,
                              Counters& counters) {
  const BeadContact& beads = contact.beads;
  const SpeciesMechanics& species_i = rules.species_of(contact.i);
  const SpeciesMechanics& species_j = rules.species_of(contact.j);
  const double offset_i = species_i.bead_offset[beads.bead_i];
  const double offset_j = species_j.bead_offset[beads.bead_j];
  const double radius_i = species_i.bead_radius[beads.bead_i];
  const double radius_j = species_j.bead_radius[beads.bead_j];
  const auto collide_along = [&](const Vec3& normal, double overlap) {
    return collide({species_i, rod_i, offset_i, offset_i * rod_i.pose.director + radius_i * normal},
                   {species_j, rod_j, offset_j, offset_j * rod_j.pose.director - radius_j * normal}, normal, overlap,
                   rules.rod_rod(contact.i, contact.j), rules, counters.ledger);
  };
  if (!rules.system.has_impacts_at_instant()) {
    if (collide_along(beads.normal, beads.overlap)) ++counters.impulses_rod_rod;
    return;
  }
  // from bead to bead as the rods are now: an impulse of the same tick may have displaced them since detection
  const auto bead_to_bead = [&]() -> Vec3 {
    return nearest_image(rod_i.pose.position, rod_j.pose.position, rules.box) + offset_j * rod_j.pose.director -
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
  if (const auto ago = impact::time_since_touch(overlap, speed, rules.dt)) {
    impact::fly(rod_i, -*ago, species_i, rules.gravity);
    impact::fly(rod_j, -*ago, species_j, rules.gravity);
    const bool have_hit = collide_along(bead_to_bead().normalized(), 0);
    impact::fly(rod_i, *ago, species_i, rules.gravity);
    impact::fly(rod_j, *ago, species_j, rules.gravity);
    if (have_hit) {
      rod_i.displaced = rod_j.displaced = true;
      ++counters.impacts_at_instant;
      ++counters.impulses_rod_rod;
      return;
    }
  }
  if (collide_along(normal, overlap)) ++counters.impulses_rod_rod;
}

/// Trouble if the overlap of a contact is too deep.
std::optional<NumericalTrouble> check_overlap(const PairContact& contact, Tick now, const TickRules& rules) {
  const double smaller = std::min(rules.species_of(contact.i).bead_radius[contact.beads.bead_i],
                                  rules.species_of(contact.j).bead_radius[contact.beads.bead_j]);
  if (contact.beads.overlap <= kMaxOverlapFraction * smaller) return {};
  return NumericalTrouble{now,
                          {contact.i, contact.j},
                          "beads " + std::to_string(contact.beads.bead_i) + " and " +
                              std::to_string(contact.beads.bead_j) + " overlap by " +
                              std::to_string(contact.beads.overlap) + " mm"};
}

/// The contacts of a tick in the order in which they get their impulses, if that is not the sorted one. What a contact
/// draws depends on its rods and on which of theirs it is: steppers may leave out pairs that cannot take part.
std::vector<PairContact> in_order(const std::vector<PairContact>& sorted, const System& system, Tick now) {
  std::vector<PairContact> contacts(sorted.rbegin(), sorted.rend());
  if (system.order == ContactOrder::kReversed) return contacts;
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
    Rng rng(system.seed, RngStream::kContacts, now, index);
    drawn.push_back({rng.bits(), contact});
  }
  std::stable_sort(drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) { return a.number < b.number; });
  std::transform(drawn.begin(), drawn.end(), contacts.begin(), [](const Drawn& d) { return d.contact; });
  return contacts;
}

}  // namespace

std::optional<NumericalTrouble> collide_rods(const std::vector<PairContact>& contacts, std::vector<RodAtTick>& rods,
                                             World& world, Tick now, const TickRules& rules) {
  for (const PairContact& contact : contacts) {
    if (auto trouble = check_overlap(contact, now, rules)) return trouble;
    world.counters.max_overlap_rod_rod = std::max(world.counters.max_overlap_rod_rod, contact.beads.overlap);
    for (const int i : {contact.i, contact.j}) evaluate_motion(rods[i], world.rods[i], now, rules.species_of(i), rules);
  }
  const auto pass_over = [&](const std::vector<PairContact>& ordered) {
    for (int sweep = 0; sweep < world.system.solver_sweeps; ++sweep) {
      for (const PairContact& contact : ordered) {
        collide(contact, rods[contact.i], rods[contact.j], rules, world.counters);
      }
    }
  };
  if (world.system.order == ContactOrder::kSorted) {
    pass_over(contacts);
  } else {
    pass_over(in_order(contacts, world.system, now));
  }
  return {};
}

}  // namespace shaken
