#include "run/loop/open_run.h"

#include <algorithm>
#include <vector>

#include "run/loop/start_state.h"
#include "scene/canonical.h"

namespace shaken::run {

std::optional<Cadence> recording_of(const scene::RunPlan& plan) {
  const std::optional<double> every = plan.recording_every();
  return every ? std::optional(Cadence(*every, plan.system.dt)) : std::nullopt;
}

TrajectoryHeader trajectory_header(const World& world, const std::string& scene_json, const Provenance& provenance) {
  return {static_cast<int>(world.rods.size()), world.cell(), world.system.dt, scene_json, provenance};
}

Provenance provenance_of(const scene::RunPlan& plan) { return {scene::run_id(plan), plan.system.seed}; }

namespace {

/// What measurements of impacts take differences of.
RunTotals totals_of(const scene::RunPlan& plan, const World& world, const Snapshot& now) {
  const Counters& counters = world.counters;
  const Ledger& ledger = counters.ledger;
  RunTotals totals;
  totals.collisions = {
      {static_cast<double>(counters.impulses_rod_rod), static_cast<double>(counters.impulses_rod_base),
       static_cast<double>(counters.impulses_rod_lid),
       static_cast<double>(counters.impulses_rod_wall + counters.impulses_rod_post),
       ledger.given.value() + ledger.noise.value(), ledger.lost_rod_rod.value(), ledger.lost_surfaces.value()},
      static_cast<double>(world.rods.size())};
  if (plan.stress) {
    std::vector<double> masses;
    for (std::size_t i = 0; i < now.velocity.size(); ++i) masses.push_back(world.species_of(i).mass);
    totals.stress.momentum_flux = analysis::momentum_flux(masses, now.velocity);
    for (std::size_t k = 0; k < ledger.virial.size(); ++k) totals.stress.virial[k] = ledger.virial[k].value();
  }
  return totals;
}

}  // namespace

OpenRun begin_run(const scene::RunPlan& plan, Simulation simulation) {
  Measurements measurements(plan, simulation.world().cell());
  return {std::move(simulation), std::move(measurements), recording_of(plan), std::nullopt, 0, 0};
}

Tick OpenRun::next_due(Tick from) const {
  const Tick sample = measurements.next_due(from);
  return recording ? std::min(sample, recording->next(from)) : sample;
}

void OpenRun::measure(const scene::RunPlan& plan, const Snapshot& now) {
  measurements.sample(now, totals_of(plan, simulation.world(), now));
}

Result<OpenRun> start_run(const scene::RunPlan& plan, const RunDirectory& directory, const std::string& scene_json,
                          const GoOn& go_on) {
  Simulation simulation = SHAKEN_TRY(start_simulation(plan, directory.root, go_on));
  OpenRun run = begin_run(plan, std::move(simulation));
  if (run.recording) {
    auto frames = SHAKEN_TRY(FrameLog::create(
        directory.frames(), trajectory_header(run.simulation.world(), scene_json, provenance_of(plan))));
    run.frames = std::move(frames);
  }
  return run;
}

Result<OpenRun> resume_run(const scene::RunPlan& plan, const RunDirectory& directory, const Checkpoint& checkpoint) {
  Simulation simulation = SHAKEN_TRY(Simulation::resume(plan.system, checkpoint.simulation));
  OpenRun run = begin_run(plan, std::move(simulation));
  run.cpu_before = checkpoint.cpu_seconds;
  run.wall_before = checkpoint.wall_seconds;
  if (auto done = run.measurements.restore(checkpoint.measurements); !done) {
    return Error{"the checkpoint's measurements are not of this plan: saved analysis state: " + done.error().message};
  }
  if (run.recording) {
    auto frames =
        reopen_frames(directory, static_cast<std::size_t>(run.simulation.tick() / run.recording->period() + 1));
    if (!frames) return frames.error();
    run.frames = std::move(frames).value();
  }
  return run;
}

Checkpoint make_checkpoint(const OpenRun& run, double cpu_seconds, double wall_seconds) {
  return {run.simulation.checkpoint(), run.measurements.save(), cpu_seconds, wall_seconds};
}

}  // namespace shaken::run
