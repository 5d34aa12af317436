#include "sim/world.h"

#include <utility>

#include "base/core/rng.h"
#include "base/core/sincos.h"
#include "sim/rod/sizes.h"

namespace shaken {
namespace {

/// Shapes in random order (Fisher & Yates), by the seed.
std::vector<std::uint8_t> draw_shapes(const std::vector<Component>& components, std::uint64_t seed) {
  std::vector<std::uint8_t> shape_of_rod;
  for (std::size_t k = 0; k < components.size(); ++k) {
    shape_of_rod.insert(shape_of_rod.end(), static_cast<std::size_t>(components[k].count),
                        static_cast<std::uint8_t>(k));
  }
  if (components.size() == 1) return shape_of_rod;
  Rng shuffle(seed, RngStream::kKinds, 0, 0);
  for (std::size_t k = shape_of_rod.size() - 1; k > 0; --k)
    std::swap(shape_of_rod[k], shape_of_rod[shuffle.below(k + 1)]);
  return shape_of_rod;
}

}  // namespace

Gravity System::gravity_on_plates() const {
  Gravity on_plates(gravity);
  if (!has_inclination()) return on_plates;
  const SinCos slope = sincos(inclination * (kPi / 180.0));
  const SinCos direction = sincos(inclination_angle * (kPi / 180.0));
  on_plates.down = gravity * slope.cos;
  on_plates.along = gravity * slope.sin * Vec2(direction.cos, direction.sin);
  on_plates.is_inclined = true;
  return on_plates;
}

World empty_world(const System& system) {
  World world;
  world.system = system;
  const std::vector<Component> components = components_of(system);
  for (const Component& one : components) {
    world.species.push_back(make_species(one.shape));
    world.species_of_shape.push_back(one.species);
  }
  world.shape_of_rod = draw_shapes(components, system.seed);
  world.plates = PlateMotion(system);
  return world;
}

Cell World::cell() const {
  Cell cell{.box = system.box(), .gap = system.gap, .walls = system.walls, .posts = standing_posts(system)};
  for (const Species& one : species) cell.shapes.push_back(one.beads());
  if (species.size() > 1) cell.shape_of_rod = shape_of_rod;
  if (species_of_shape.back() + 1U != species.size()) cell.species_of_shape = species_of_shape;
  return cell;
}

PoseAndMotion rod_at(const World& world, std::size_t i, Tick tick) {
  const Flight& flight = world.rods[i];
  const Gravity gravity = world.system.gravity_on_plates();
  const double tau = static_cast<double>(tick - flight.since) * world.system.dt;
  const Pose pose = pose_after(flight, tau, gravity);
  return {pose, motion_after(flight, tau, gravity, pose.director, world.species_of(i).inertia_ratio)};
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
    auto [pose, motion] = rod_at(world, i, world.tick);
    auto image = world.rods[i].image;
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
