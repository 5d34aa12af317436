#include "run/loop/summary_of_run.h"

#include "base/text.h"
#include "run/loop/effects.h"
#include "scene/canonical.h"
#include "sim/balance.h"
#include "sim/physics_version.h"

namespace shaken::run {

Summary summary_of(const scene::RunPlan& plan, const OpenRun& run, const Reduction& reduction,
                   std::optional<std::int64_t> n_live_frames) {
  const World& world = run.simulation.world();
  Summary summary;
  summary.run_id = scene::run_id(plan);
  summary.physics = physics_version(plan.system);
  summary.start = plan.start;
  summary.n_rods = static_cast<int>(world.rods.size());
  summary.sim_seconds = run.simulation.time();
  summary.collisions_rod_rod = world.counters.impulses_rod_rod;
  summary.collisions_rod_base = world.counters.impulses_rod_base;
  summary.collisions_rod_lid = world.counters.impulses_rod_lid;
  summary.collisions_rod_wall = world.counters.impulses_rod_wall;
  summary.collisions_rod_post = world.counters.impulses_rod_post;
  summary.max_overlap = world.counters.max_overlap();
  summary.balance = balance(world);
  fill(summary, plan, reduction);
  summary.effects = report_effects(plan, run, n_live_frames);
  summary.state_hash = run.simulation.state_hash();
  summary.finished = utc_now();
  summary.tick = run.simulation.tick();
  return summary;
}

}  // namespace shaken::run
