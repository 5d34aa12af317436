#pragma once

#include <optional>
#include <string>

#include "run/files/checkpoint_file.h"
#include "run/files/directory.h"
#include "run/files/trajectory.h"
#include "run/measure/cadence.h"
#include "run/measure/measurements.h"
#include "scene/keys/run_plan.h"
#include "sim/simulation.h"

namespace shaken::run {

/// What a run consists of while it is under way; a checkpoint holds or pins down all of it.
struct OpenRun {
  Simulation simulation;
  Measurements measurements;
  std::optional<Cadence> recording;  ///< of the trajectory: the finer of what `trajectory` and `movie` ask for
  std::optional<FrameLog> frames;    ///< recorded so far
  double cpu_before = 0;             ///< seconds spent by predecessors
  double wall_before = 0;            ///< the same

  /// The first tick >= `from` at which something is sampled or recorded.
  Tick next_due(Tick from) const;
  /// Takes the samples that are due now; `now` is the snapshot of the simulation.
  void measure(const scene::RunPlan& plan, const Snapshot& now);
};

/// When frames are recorded: the finer of what `trajectory` and `movie` ask for; none if neither is there.
std::optional<Cadence> recording_of(const scene::RunPlan& plan);
/// What a trajectory says of the world besides its frames.
TrajectoryHeader trajectory_header(const World& world, const std::string& scene_json, const Provenance& provenance);
/// The run that the files of a plan are of.
Provenance provenance_of(const scene::RunPlan& plan);

/// A run of `simulation` where it stands, of which nothing is sampled yet, without files.
OpenRun begin_run(const scene::RunPlan& plan, Simulation simulation);
/// A run at tick 0, with the files that it records into. Nothing is sampled yet. A compressed start asks `go_on`.
Result<OpenRun> start_run(const scene::RunPlan& plan, const RunDirectory& directory, const std::string& scene_json,
                          const GoOn& go_on = {});

/// The run as it was at `checkpoint`, all samples up to its tick taken. Fails if the checkpoint, the measurements or
/// the trajectory on the disk do not fit together.
Result<OpenRun> resume_run(const scene::RunPlan& plan, const RunDirectory& directory, const Checkpoint& checkpoint);

/// A checkpoint of the run.
Checkpoint make_checkpoint(const OpenRun& run, double cpu_seconds, double wall_seconds);

}  // namespace shaken::run
