#include "sim/bounds/surface_safe_ticks.h"

#include <algorithm>

#include "sim/bounds/margins.h"
#include "sim/motion/post_contacts.h"
#include "sim/motion/side_walls.h"

namespace shaken {
namespace {

bool is_in_plate(const Species& species, const Pose& pose, const PlateState& plates, const TickRules& rules) {
  return std::ranges::any_of(species.outer_beads, [&](int bead) {
    const double z = pose.position.z() + species.bead_offset[bead] * pose.director.z();
    const double radius = species.bead_radius[bead];
    return (rules.system.base && z - radius < plates.base) || (rules.system.lid && z + radius > plates.lid);
  });
}

}  // namespace

void off_surface_ticks(std::span<const int> rods, const World& world, const std::vector<RodAtTick>& at_tick, Tick now,
                       Tick horizon, const TickRules& rules, PlateLanes& lanes, Tick* ticks) {
  const Species& species = rules.species_of(rods.front());
  std::fill_n(ticks, kLanes, horizon);
  if (rules.system.base || rules.system.lid) {
    for (std::size_t lane = 0; lane < rods.size(); ++lane) {
      const Flight& flight = world.rods[rods[lane]];
      const Pose& pose = at_tick[rods[lane]].pose;
      lanes.z[lane] = static_cast<float>(pose.position.z());
      lanes.velocity[lane] = static_cast<float>(velocity_at(flight, now, rules).z());
      lanes.n_z[lane] = static_cast<float>(pose.director.z());
      lanes.n_z_rate[lane] =
          static_cast<float>(flight.precession.x() * pose.director.y() - flight.precession.y() * pose.director.x());
      lanes.rate2[lane] = static_cast<float>(flight.rate * flight.rate);
    }
    plate_safe_ticks(species, world.plates, lanes, static_cast<int>(rods.size()), rules.gravity.down, rules.dt, now,
                     horizon, ticks, {rules.system.base, rules.system.lid, rules.rest});
  }
  if (rules.system.has_impacts_at_instant()) {
    // An impact on one bead may have pressed another deeper into a plate than it was found, though it recedes: the next
    // tick sees how deep.
    const PlateState plates = world.plates.at(now);
    for (std::size_t lane = 0; lane < rods.size(); ++lane) {
      const RodAtTick& rod = at_tick[rods[lane]];
      if (rod.displaced && is_in_plate(species, rod.pose, plates, rules)) ticks[lane] = 0;
    }
  }
  if (!rules.has_uprights()) return;
  const double pull = rules.gravity.along_size();
  for (std::size_t lane = 0; lane < rods.size(); ++lane) {
    const Pose& pose = at_tick[rods[lane]].pose;
    Flight flight = world.rods[rods[lane]];
    if (pull > 0) flight.velocity = velocity_at(flight, now, rules);
    double time = static_cast<double>(horizon) * rules.dt;
    if (rules.system.walls) time = wall_safe_time(*rules.system.walls, rules.box, species, pose, flight, time, pull);
    if (rules.posts) time = post_safe_time(*rules.posts, rules.box, species, pose, flight, time, pull);
    ticks[lane] = std::min(ticks[lane], static_cast<Tick>(time / rules.dt * (1.0 - margins::kWallTime)));
  }
}

}  // namespace shaken
