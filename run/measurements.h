// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/angles.h"
#include "analysis/blocked.h"
#include "analysis/defect_series.h"
#include "analysis/g2.h"
#include "analysis/msd.h"
#include "analysis/order.h"
#include "analysis/tilt.h"
#include "run/cadence.h"
#include "run/files/observables_file.h"
#include "scene/run_plan.h"
#include "sim/rod/species.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// The largest |n_z| of a rod that touches both plates without overlap, at most 1.
double largest_tilt(const Species& species, double gap);

/// What the measurements say of the run as a whole.
struct Reduction {
  Observables arrays;
  double t_steady = 0;  ///< as given, as found from S(t), or half the run where neither is there [s]
  std::optional<analysis::SteadySummary> order;
  std::optional<analysis::DefectSeries::MeanCounts> defects;
};

/// Everything that the plan asks to measure while the run goes on. Samples are due at integer multiples of each
/// measurement's own period, tick 0 included. What the plan does not ask for costs nothing.
class Measurements {
 public:
  /// Of rods of the first kind; `kinds` (n_rods) says which these are, or is empty if there is no other.
  Measurements(const scene::RunPlan& plan, const Species& species, std::span<const std::uint8_t> kinds = {});

  /// The first tick >= `from` at which a sample is due; kNever if nothing is measured.
  Tick next_due(Tick from) const;
  /// Takes the samples that are due at the snapshot's tick.
  void sample(const Snapshot& snapshot);

  /// Mean of S over the second half of the run so far; 0 where it is not measured.
  double order_running_mean() const;
  /// Tick and defects of the last sample of defects.
  struct DefectSample {
    Tick tick = 0;
    double time = 0;       ///< [s]
    double smoothing = 0;  ///< [mm]
    std::vector<analysis::Defect> defects;
  };
  const std::optional<DefectSample>& last_defects() const { return last_defects_; }

  /// `sim_seconds` is the length of the run so far.
  Reduction reduce(double sim_seconds) const;
  /// Samples taken, by measurement ("order", "angles", "tilt", "defects", "g2", "msd"); those switched off are not in
  /// it.
  std::map<std::string, std::int64_t> counts() const;

  std::vector<std::byte> save() const;
  /// Takes up what save() gave; throws analysis::StateError if the bytes belong to another plan.
  void restore(std::span<const std::byte> bytes);

 private:
  template <class Accumulator>
  struct Timed {
    Cadence cadence;
    Accumulator accumulator;
    std::int64_t samples = 0;
  };
  void sample_rods(const Snapshot& snapshot);
  template <class Visitor>
  void visit(Visitor visitor);
  template <class Visitor>
  void visit(Visitor visitor) const;

  std::vector<std::size_t> measured_;  // rods of the first kind, where there are others; or empty
  std::optional<double> steady_;
  std::optional<SideWalls> walls_;
  double smoothing_ = 0;  // of the director field [mm]
  double mesh_ = 0;       // of its grid, at most [mm]
  std::optional<Timed<analysis::OrderSeries>> order_;
  std::optional<Timed<analysis::Blocked<analysis::AngleDistribution>>> angles_;
  std::optional<Timed<analysis::Blocked<analysis::TiltVelocity>>> tilt_;
  std::optional<Timed<analysis::DefectSeries>> defects_;
  std::optional<Timed<analysis::Blocked<analysis::OrientationCorrelation>>> g2_;
  /// Counts from the given steady time on; where that is found only afterwards, from the start of the run.
  std::optional<Timed<analysis::MeanSquareDisplacement>> msd_;
  std::optional<DefectSample> last_defects_;
};

}  // namespace shaken::run
