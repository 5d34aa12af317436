// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "run/probe/probe.h"
#include "sim/rod/species.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// What the measurements of a plan cost, each by itself.
struct SamplingCost {
  std::map<std::string, Cost> samples;  ///< by effect, "measure_order"
  double file_bytes = 0;                ///< of observables.h5 at the end of the run
  double state_bytes = 0;               ///< of the measurements in the checkpoint at the end of the run
};

/// Takes a few samples of each measurement at some states of the plan's rods, at least one.
SamplingCost time_sampling(const scene::RunPlan& plan, const Species& species, const std::vector<Snapshot>& snapshots);

}  // namespace shaken::run
