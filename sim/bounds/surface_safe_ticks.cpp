// SPDX-License-Identifier: MIT
#include "sim/bounds/surface_safe_ticks.h"

#include <algorithm>

#include "sim/bounds/margins.h"
#include "sim/motion/side_walls.h"

namespace shaken {

void off_surface_ticks(std::span<const int> rods, const World& world, const std::vector<RodAtTick>& at_tick, Tick now,
                       Tick horizon, const TickRules& rules, PlateLanes& lanes, Tick* ticks) {
  const Species& species = rules.species_of(rods.front());
  std::fill_n(ticks, kLanes, horizon);
  if (rules.has_base || rules.has_lid) {
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
    plate_safe_ticks(species, world.plates, lanes, static_cast<int>(rods.size()), rules.gravity, rules.dt, now, horizon,
                     ticks, {rules.has_base, rules.has_lid, rules.rest});
  }
  if (!rules.walls) return;
  for (std::size_t lane = 0; lane < rods.size(); ++lane) {
    const double time = wall_safe_time(*rules.walls, rules.box, species, at_tick[rods[lane]].pose,
                                       world.rods[rods[lane]], static_cast<double>(horizon) * rules.dt);
    ticks[lane] = std::min(ticks[lane], static_cast<Tick>(time / rules.dt * (1.0 - margins::kWallTime)));
  }
}

}  // namespace shaken
