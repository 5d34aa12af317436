// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/tilt.h"
#include "bench/accuracy/fits.h"
#include "bench/accuracy/observables.h"
#include "bench/accuracy/start_case.h"
#include "bench/case.h"
#include "bench/report.h"

namespace shaken::bench {

/// What is turned to trade accuracy for time.
enum class Knob { kStep, kPitch, kSweeps };
inline constexpr std::array<const char*, 3> kKnobNames{"step", "bead pitch", "sweeps"};
inline constexpr std::array<const char*, 3> kKnobUnits{"us", "mm", "1"};

/// One knob turned in one scene.
struct StatisticsTask {
  Case scene;  ///< its plan: everything but the knob
  const Variant* variant = &variants().front();
  Knob knob = Knob::kStep;
  std::vector<double> values;  ///< from most to least accurate [kKnobUnits]
  double measure = 0;          ///< simulated per value and replica [s]
  double settle = 0;           ///< simulated before, from the steady state of the scene [s]
  int replicas = 1;            ///< with seeds 1, 2, ...
};

/// What was measured at one value of the knob.
struct StatisticsPoint {
  double value = 0;
  std::array<Mean, kObservables> means;
  std::array<Mean, kObservables> biases;  ///< relative to the limit; of impulses relative to the first value
  double cpu_per_rod_second = 0;
  double max_overlap = 0;  ///< [mm]
  analysis::TiltCurve tilt;
};

/// A straight line is believed up to so many times the finest step.
inline constexpr double kLinear = 8;

struct Statistics {
  StatisticsTask task;
  std::vector<StatisticsPoint> points;
  /// Steps: the limit dt -> 0 of those up to limit_step(). None for other knobs: their limit is the first value.
  std::array<std::optional<Limit>, kObservables> limits;
  /// Where a straight line is believed [us].
  double limit_step() const { return kLinear * task.values.front(); }
};

/// Where the bias of an observable is settled.
inline constexpr double kBound = 0.01;

/// Every value and replica in turn, each from the steady state of the scene with its seed, which comes from `cache`;
/// with another bead pitch from a steady state of its own.
Statistics measure_statistics(const StatisticsTask& task, const Cache& cache);
Report statistics_report(const std::vector<Statistics>& measured);

/// A simulation at step `dt` that goes on from where `from` is, to the nearest tick.
Simulation continued(const Simulation& from, const System& scene);

}  // namespace shaken::bench
