#include "sim/tick/tick.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <span>
#include <string>

#include "sim/motion/start_motion.h"

namespace shaken {

double max_speed(const World& world) {
  const System& system = world.system;
  const double usual = world.plates.peak_speed() + world.plates.peak_slide() +
                       std::sqrt(2.0 * system.gravity * system.gap) + kStartSpeed;
  double thinnest = system.gap;
  for (const Species& species : world.species) {
    for (const double radius : species.bead_radius) thinnest = std::min(thinnest, radius);
  }
  return std::min(kMaxSpeedFactor * usual, thinnest / system.dt);
}

namespace {

/// `species_of_shape` (n_shapes) does not count species that a scene leaves out.
void set_materials(const System& system, std::span<const std::uint8_t> species_of_shape,
                   std::vector<SpeciesMechanics>& species) {
  std::vector<std::size_t> numbers;
  for (std::size_t number = 0; number < kMostSpecies; ++number) {
    if (system.has_species(number)) numbers.push_back(number);
  }
  for (std::size_t k = 0; k < species.size(); ++k) {
    const std::size_t number = numbers[species_of_shape[k]];
    species[k].number = number;
    species[k].base = system.rod_base.of(number);
    species[k].lid = system.rod_lid.of(number);
    species[k].rotational_noise = system.noise_of(number);
    if (system.walls) species[k].wall = system.walls->contact.of(number);
    if (system.posts) species[k].post = system.posts->contact.of(number);
    for (const std::size_t other : numbers) species[k].rods[other] = system.rod_rod.of(number, other);
  }
}

}  // namespace

TickRules::TickRules(const World& world)
    : system(world.system),
      shape_of_rod(world.shape_of_rod),
      gravity(system.gravity_on_plates()),
      dt(system.dt),
      box(system.box()),
      impulse(impulse_function(system.law)),
      plates(world.plates) {
  for (const Species& one : world.species) species.emplace_back(one);
  if (system.posts) posts.emplace(standing_posts(system), box, period_of(box, system.walls));
  set_materials(system, world.species_of_shape, species);
  max_speed2 = max_speed(world) * max_speed(world);
  if (system.lets_rods_rest()) rest = {0.5 * gravity.down * dt, kRiseRate};
}

NumericalTrouble motion_trouble(int index, const RodAtTick& rod, Tick now, const TickRules& rules) {
  const double speed2 = rod.motion.velocity.squaredNorm();
  if (std::isfinite(speed2) && speed2 > rules.max_speed2) {
    return {now,
            {index},
            "a speed of " + std::to_string(std::sqrt(speed2)) + " mm/s, where at most " +
                std::to_string(std::sqrt(rules.max_speed2)) + " can be meant"};
  }
  return {now,
          {index},
          std::isfinite(speed2) ? "velocity or position is not a finite number" : "velocity is not a finite number"};
}

void sort_contacts(std::vector<PairContact>& contacts, const std::vector<RodAtTick>& rods, const TickRules& rules) {
  const auto place = [&](int i, int bead) -> Vec3 {
    return rules.species_of(i).bead_offset[bead] * rods[i].pose.director;
  };
  const auto compare = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(contacts.begin(), contacts.end(), [&](const PairContact& a, const PairContact& b) {
    if (a.i != b.i) return a.i < b.i;
    if (a.j != b.j) return a.j < b.j;
    if (a.beads.overlap != b.beads.overlap) return a.beads.overlap > b.beads.overlap;
    const auto of_i = compare(place(a.i, a.beads.bead_i), place(b.i, b.beads.bead_i));
    if (std::is_neq(of_i)) return std::is_lt(of_i);
    return std::is_lt(compare(place(a.j, a.beads.bead_j), place(b.j, b.beads.bead_j)));
  });
}

}  // namespace shaken
