// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/case.h"
#include "sim/simulation.h"

namespace shaken::bench {

/// What one observable costs in a run.
struct AnalysisCost {
  std::string name;          ///< block of the scene: measure.NAME
  double every = 0;          ///< [s]
  std::int64_t samples = 0;  ///< taken
  double cpu = 0;            ///< spent on them [s]
};

/// A stretch of a run, taken apart.
struct AnalysisShares {
  double sim_seconds = 0;
  double cpu_steps = 0;      ///< stepping [s]
  double cpu_snapshots = 0;  ///< reading all rods at the ticks at which something is sampled [s]
  std::vector<AnalysisCost> observables;

  double cpu_analysis() const;  ///< snapshots and observables [s]
  double share() const;         ///< of the analysis in the whole
};

/// Steps `simulation` for `sim_seconds` and takes every sample that `plan` asks for meanwhile, timing each observable.
AnalysisShares measure_analysis(const scene::RunPlan& plan, Simulation& simulation, double sim_seconds);

}  // namespace shaken::bench
