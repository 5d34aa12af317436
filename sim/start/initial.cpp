#include "sim/start/initial.h"

#include <string>

#include "base/core/check.h"
#include "sim/balance.h"
#include "sim/overlaps.h"
#include "sim/start/aligned_rods.h"
#include "sim/start/placement.h"
#include "sim/start/random_rods.h"

namespace shaken {

Result<std::vector<Flight>> initial_flights(const System& system, std::span<const Species> species,
                                            std::span<const std::uint8_t> shape_of_rod, const DirectorAt& directors) {
  SHAKEN_CHECK(!is_compressed(system.start), "sim/start/compression.h makes that");
  SHAKEN_CHECK(!directors || system.start == Start::kRandom, "only rods at random places follow a pattern");
  const Placement rods(system, species, shape_of_rod);
  if (rods.plates.gap < 2.0 * rods.max_radius()) return Error{"the gap is smaller than the thickest bead"};
  if (const double least = least_box_side(species); system.box().shorter() < least * (1.0 - 1e-9)) {
    return Error{"the box is too small: rods might meet two images of another below " + std::to_string(least) + " mm"};
  }
  return system.start == Start::kAligned ? aligned_rods(rods) : random_rods(rods, directors);
}

Result<World> make_world(const System& system) { return make_world_along(system, {}); }

Result<World> make_world_along(const System& system, const DirectorAt& directors) {
  World world = empty_world(system);
  auto flights = initial_flights(system, world.species, world.shape_of_rod, directors);
  if (!flights) return flights.error();
  world.rods = std::move(flights).value();
  // what was promised is checked, not believed
  std::vector<Pose> poses;
  for (const Flight& flight : world.rods) poses.push_back({flight.position, flight.director});
  const std::size_t n_overlaps = find_overlaps(world, world.shape_of_rod, poses).size();
  SHAKEN_CHECK(n_overlaps == 0, std::to_string(n_overlaps) + " overlaps in the initial state");
  world.start = content(world);
  return world;
}

}  // namespace shaken
