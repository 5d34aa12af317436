// SPDX-License-Identifier: MIT
#include "sim/world.h"

#include <utility>

#include "base/core/rng.h"

namespace shaken {
namespace {

/// Kinds in random order (Fisher & Yates), by the seed.
std::vector<std::uint8_t> draw_kinds(const System& system) {
  std::vector<std::uint8_t> species_of_rod(static_cast<std::size_t>(system.n_rods), 0);
  std::uint8_t kind = 0;
  for (const auto& more : system.added) {
    if (more) species_of_rod.insert(species_of_rod.end(), static_cast<std::size_t>(more->count), ++kind);
  }
  if (kind == 0) return species_of_rod;
  Rng shuffle(system.seed, RngStream::kKinds, 0, 0);
  for (std::size_t k = species_of_rod.size() - 1; k > 0; --k)
    std::swap(species_of_rod[k], species_of_rod[shuffle.below(k + 1)]);
  return species_of_rod;
}

}  // namespace

World empty_world(const System& system) {
  World world;
  world.system = system;
  world.species.push_back(make_species(system.rod));
  for (const auto& more : system.added) {
    if (more) world.species.push_back(make_species(more->rod));
  }
  world.species_of_rod = draw_kinds(system);
  world.plates = PlateMotion(
      system.amplitude, system.frequency, system.gap, system.dt,
      {system.horizontal_amplitude, system.horizontal_phase * (kPi / 180.0), system.horizontal_angle * (kPi / 180.0)});
  return world;
}

Cell World::cell() const {
  Cell cell{.box = system.box(), .gap = system.gap, .walls = system.walls, .posts = standing_posts(system)};
  for (const Species& kind : species) cell.species.push_back(kind.beads());
  if (species.size() > 1) cell.species_of_rod = species_of_rod;
  return cell;
}

Snapshot snapshot(const World& world) {
  Snapshot out;
  out.tick = world.tick;
  out.time = static_cast<double>(world.tick) * world.system.dt;
  out.box = world.system.box();
  const std::size_t n = world.rods.size();
  out.position.reserve(n);
  out.image.reserve(n);
  out.director.reserve(n);
  out.velocity.reserve(n);
  out.angular_velocity.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Flight& flight = world.rods[i];
    const Species& species = world.species_of(i);
    const double tau = static_cast<double>(world.tick - flight.since) * world.system.dt;
    Pose pose = pose_after(flight, tau, world.system.gravity);
    const Motion motion =
        motion_after(flight, tau, world.system.gravity, pose.director, species.inertia_par / species.inertia_perp);
    auto image = flight.image;
    wrap(pose.position.x(), image[0], out.box.x());
    wrap(pose.position.y(), image[1], out.box.y());
    out.position.push_back(pose.position);
    out.image.push_back(image);
    out.director.push_back(pose.director);
    out.velocity.push_back(motion.velocity);
    out.angular_velocity.push_back(motion.angular_velocity);
  }
  return out;
}

}  // namespace shaken
