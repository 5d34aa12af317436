// SPDX-License-Identifier: MIT
#include "sim/world.h"

#include <utility>

#include "sim/core/rng.h"

namespace shaken {
namespace {

/// Kinds in random order (Fisher & Yates), by the seed.
std::vector<std::uint8_t> draw_kinds(const Scene& scene) {
  std::vector<std::uint8_t> kinds(static_cast<std::size_t>(scene.n_rods), 0);
  std::uint8_t kind = 0;
  for (const auto& more : scene.added) {
    if (more) kinds.insert(kinds.end(), static_cast<std::size_t>(more->count), ++kind);
  }
  if (kind == 0) return kinds;
  Rng shuffle(scene.seed, RngStream::kKinds, 0, 0);
  for (std::size_t k = kinds.size() - 1; k > 0; --k) std::swap(kinds[k], kinds[shuffle.below(k + 1)]);
  return kinds;
}

}  // namespace

World empty_world(const Scene& scene) {
  World world;
  world.scene = scene;
  world.species.push_back(make_species(scene.rod));
  for (const auto& more : scene.added) {
    if (more) world.species.push_back(make_species(more->rod));
  }
  world.kinds = draw_kinds(scene);
  world.plates = PlateMotion(scene.amplitude, scene.frequency, scene.gap, scene.dt);
  return world;
}

Snapshot snapshot(const World& world) {
  Snapshot out;
  out.tick = world.tick;
  out.time = static_cast<double>(world.tick) * world.scene.dt;
  out.box_side = world.scene.box_side;
  const std::size_t n = world.rods.size();
  out.position.reserve(n);
  out.image.reserve(n);
  out.director.reserve(n);
  out.velocity.reserve(n);
  out.angular_velocity.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Flight& flight = world.rods[i];
    const Species& species = world.species_of(i);
    const double tau = static_cast<double>(world.tick - flight.since) * world.scene.dt;
    Pose pose = pose_after(flight, tau, world.scene.gravity);
    const Motion motion =
        motion_after(flight, tau, world.scene.gravity, pose.director, species.inertia_par / species.inertia_perp);
    auto image = flight.image;
    wrap(pose.position.x(), image[0], world.scene.box_side);
    wrap(pose.position.y(), image[1], world.scene.box_side);
    out.position.push_back(pose.position);
    out.image.push_back(image);
    out.director.push_back(pose.director);
    out.velocity.push_back(motion.velocity);
    out.angular_velocity.push_back(motion.angular_velocity);
  }
  return out;
}

}  // namespace shaken
