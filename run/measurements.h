// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "run/cadence.h"
#include "run/measure/measure_defects.h"
#include "run/measure/measure_order.h"
#include "run/measure/measurement_kinds.h"
#include "run/measure/reduction.h"
#include "scene/run_plan.h"
#include "sim/cell.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// Everything that the plan asks to measure while the run goes on. Samples are due at integer multiples of each
/// measurement's own period, tick 0 included, or once in each of these intervals (MeasurementKind::is_spread). What the
/// plan does not ask for costs nothing.
class Measurements {
 public:
  /// Of rods of the first species; `cell` says which these are, and may be left out if there is no other.
  explicit Measurements(const scene::RunPlan& plan, Cell cell = {});

  /// The first tick >= `from` at which a sample is due; kNever if nothing is measured.
  Tick next_due(Tick from) const;
  /// Takes the samples that are due at the snapshot's tick.
  void sample(const Snapshot& snapshot);

  /// Mean of S over the second half of the run so far; 0 where it is not measured.
  double order_running_mean() const;
  /// The last sample of defects, if they are measured.
  const DefectSample* last_defects() const;

  /// `sim_seconds` is the length of the run so far.
  Reduction reduce(double sim_seconds) const;
  /// Samples taken, by measurement ("order", "g2", ...); those switched off are not in it.
  std::map<std::string, std::int64_t> counts() const;

  std::vector<std::byte> save() const;
  /// Takes up what save() gave. Fails if the bytes belong to another plan; the object is then of no more use.
  Result<void> restore(std::span<const std::byte> bytes);

 private:
  struct Timed {
    std::string name;
    Cadence cadence;
    std::unique_ptr<Measurement> measurement;
    std::int64_t samples = 0;
  };

  Cell cell_;
  std::optional<double> steady_;
  bool has_axis_ = true;  ///< of the rods that are measured
  std::vector<Timed> timed_;
  const MeasuredOrder* order_ = nullptr;      // one of timed_, or null
  const MeasuredDefects* defects_ = nullptr;  // the same
};

}  // namespace shaken::run
