#include "sim/balance.h"

#include <cmath>

#include "sim/world.h"

namespace shaken {
namespace {

/// Calls visit(species, pose, motion) for every rod at the world's tick, where it would be without periodic boundaries.
template <class Visit>
void for_each_rod(const World& world, const Visit& visit) {
  const Box box = world.system.box();
  for (std::size_t i = 0; i < world.rods.size(); ++i) {
    auto [pose, motion] = rod_at(world, i, world.tick);
    pose.position.x() += world.rods[i].image[0] * box.x();
    pose.position.y() += world.rods[i].image[1] * box.y();
    visit(world.species_of(i), pose, motion);
  }
}

double mass_of_all(const World& world) {
  double mass = 0;
  for (std::size_t i = 0; i < world.rods.size(); ++i) mass += world.species_of(i).mass;
  return mass;
}

}  // namespace

KineticEnergy kinetic_energy(const World& world) {
  KineticEnergy energy;
  for_each_rod(world, [&](const Species& species, const Pose& pose, const Motion& motion) {
    const Vec3& v = motion.velocity;
    energy.translation_xy += 0.5 * species.mass * (v.x() * v.x() + v.y() * v.y());
    energy.translation_z += 0.5 * species.mass * v.z() * v.z();
    const double along = motion.angular_velocity.dot(pose.director);
    const double across2 = motion.angular_velocity.squaredNorm() - along * along;
    energy.rotation += 0.5 * (species.inertia_perp * across2 + species.inertia_par * along * along);
  });
  return energy;
}

Content content(const World& world) {
  Content content;
  content.tick = world.tick;
  content.energy = kinetic_energy(world).total();
  const Gravity gravity = world.system.gravity_on_plates();
  for_each_rod(world, [&](const Species& species, const Pose& pose, const Motion& motion) {
    content.energy += species.mass * gravity.down * pose.position.z();
    if (gravity.is_inclined) content.energy -= species.mass * gravity.along.dot(pose.position.head<2>());
    content.momentum += species.mass * motion.velocity;
  });
  return content;
}

Balance balance(const World& world) {
  const Ledger& ledger = world.counters.ledger;
  const Content now = content(world);
  Balance balance;
  balance.energy_start = world.start.energy;
  balance.energy_given_by_surfaces = ledger.given.value();
  balance.energy_given_by_noise = ledger.noise.value();
  balance.energy_lost_rod_rod = ledger.lost_rod_rod.value();
  balance.energy_lost_surfaces = ledger.lost_surfaces.value();
  balance.energy_now = now.energy;
  balance.energy_unexplained = balance.energy_start + balance.energy_given_by_surfaces + balance.energy_given_by_noise -
                               balance.energy_lost_rod_rod - balance.energy_lost_surfaces - balance.energy_now;
  balance.momentum_unexplained = world.start.momentum - now.momentum;
  for (int c = 0; c < 3; ++c) balance.momentum_unexplained[c] += ledger.momentum[static_cast<std::size_t>(c)].value();
  const Gravity gravity = world.system.gravity_on_plates();
  const double mass_time = static_cast<double>(world.tick - world.start.tick) * world.system.dt * mass_of_all(world);
  balance.momentum_unexplained.z() -= mass_time * gravity.down;
  balance.momentum_unexplained.head<2>() += mass_time * gravity.along;
  return balance;
}

double Balance::energy_error() const {
  double turnover = 0;
  for (const double amount : {energy_start, energy_given_by_surfaces, energy_given_by_noise, energy_lost_rod_rod,
                              energy_lost_surfaces, energy_now})
    turnover += std::abs(amount);
  return turnover > 0 ? std::abs(energy_unexplained) / turnover : 0.0;
}

}  // namespace shaken
