// SPDX-License-Identifier: MIT
#include "sim/world.h"

#include <xxhash.h>

#include "sim/checkpoint.h"
#include "sim/initial.h"

namespace shaken {
namespace {

/// Pose and motion of rod i at the world's tick.
std::pair<Pose, Motion> evaluate(const World& world, const Flight& flight) {
  const double tau = static_cast<double>(world.tick - flight.since) * world.scene.dt;
  const Pose pose = pose_after(flight, tau, world.scene.gravity);
  return {pose, motion_after(flight, tau, world.scene.gravity, pose.director,
                             world.species.inertia_par / world.species.inertia_perp)};
}

}  // namespace

World empty_world(const Scene& scene) {
  World world;
  world.scene = scene;
  world.species = make_species(scene.rod);
  world.plates = PlateMotion(scene.amplitude, scene.frequency, scene.gap, scene.dt);
  return world;
}

Result<World> make_world(const Scene& scene) {
  World world = empty_world(scene);
  auto flights = initial_flights(scene, world.species);
  if (!flights) return flights.error();
  world.rods = std::move(flights).value();
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
  for (const Flight& flight : world.rods) {
    auto [pose, motion] = evaluate(world, flight);
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

KineticEnergy kinetic_energy(const World& world) {
  KineticEnergy energy;
  const Species& species = world.species;
  for (const Flight& flight : world.rods) {
    const auto [pose, motion] = evaluate(world, flight);
    const Vec3& v = motion.velocity;
    energy.translation_xy += 0.5 * species.mass * (v.x() * v.x() + v.y() * v.y());
    energy.translation_z += 0.5 * species.mass * v.z() * v.z();
    const double along = motion.angular_velocity.dot(pose.director);
    const double across2 = motion.angular_velocity.squaredNorm() - along * along;
    energy.rotation += 0.5 * (species.inertia_perp * across2 + species.inertia_par * along * along);
  }
  return energy;
}

std::uint64_t state_hash(const World& world) {
  const std::vector<std::byte> bytes = state_bytes(world);
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace shaken
