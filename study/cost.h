// SPDX-License-Identifier: MIT
// What the sweeps of a study cost from nothing, and how long they take on so many cores.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "client/cost_estimate.h"
#include "client/slurm_estimate.h"
#include "study/selection.h"

namespace shaken::study {

using client::Json;

/// What runs take together, on cores like those of this machine; what others run there is not in it.
struct Cost {
  std::size_t n_runs = 0;
  double rod_seconds = 0;
  double disk = 0;           ///< that stays [bytes]
  double room = 0;           ///< that the disk must have, if all that are at work at once end together [bytes]
  double memory = 0;         ///< of the run that takes most [bytes]
  std::size_t n_files = 0;   ///< at most
  double longest_run = 0;    ///< wall time [s]
  client::SlurmLoad load{};  ///< here too a task is what a core does without a pause: one run
  client::SlurmEstimate estimate{};
};

struct SweepCost {
  std::string name;
  scene::SlurmSettings slurm{};
  Cost cost;
};

struct StudyCost {
  bool slurm = false;  ///< whether any of the sweeps goes there
  int cores = 0;       ///< at once; 0: as many as there are tasks
  std::vector<SweepCost> sweeps;
  Cost all;  ///< of them together, begun in their order
};

/// An estimate without the digits that it cannot know: rounded to two.
double two_digits(double value);

/// Files that a run leaves in its directory, at most.
std::size_t n_files_of(const scene::RunPlan& plan);

/// The costs of sweeps, given what each of their runs takes: in Slurm if any of them names it, on `cores` cores at
/// once. 0 cores are as many as there are tasks in Slurm, and those of this machine without.
StudyCost study_cost(const std::vector<const NamedSweep*>& sweeps,
                     const std::vector<std::vector<client::RunCost>>& runs, int cores);
/// The same for those of the sweeps that are needed, after a probe of some runs of each; how far that is stands on a
/// terminal.
StudyCost probed_cost(const std::vector<NamedSweep>& sweeps, const client::EstimateOptions& options, int cores,
                      const client::Console& console);

/// For people: a table of at most `width` columns, the sum, and what to think of.
std::string cost_text(const StudyCost& cost, int width);
Json cost_json(const StudyCost& cost, const std::string& scale);

/// What is worth knowing before it starts, a sentence each: tasks that are too long, too short, or have too little
/// memory.
std::vector<std::string> remarks_on(const StudyCost& cost);

}  // namespace shaken::study
