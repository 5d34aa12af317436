#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "run/measure/cadence.h"
#include "run/measure/measure_defects.h"
#include "run/measure/measure_order.h"
#include "run/measure/measurement_kinds.h"
#include "run/measure/reduction.h"
#include "scene/keys/run_plan.h"
#include "sim/cell.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// Everything that the plan asks to measure while the run goes on. Samples are due at integer multiples of each
/// measurement's own period, tick 0 included, or once in each of these intervals (Observable::is_spread). What the
/// plan does not ask for costs nothing.
class Measurements {
 public:
  /// Measures the species that the plan names; `cell` says which rods these are, and may be left out if there is but
  /// one.
  explicit Measurements(const scene::RunPlan& plan, Cell cell = {});

  /// The first tick >= `from` at which a sample is due; kNever if nothing is measured.
  Tick next_due(Tick from) const;
  /// Takes the samples that are due at the snapshot's tick; `totals` are of the run up to it.
  void sample(const Snapshot& snapshot, const RunTotals& totals = {});

  /// Mean of S over the second half of the run so far; 0 where it is not measured.
  double order_running_mean() const;
  /// The last sample of defects, if they are measured.
  const DefectSample* last_defects() const;

  /// `sim_seconds` is the length of the run so far.
  Reduction reduce(double sim_seconds) const;
  /// Samples taken, by measurement ("order", "g2", ...), of all species together; those switched off are not in it.
  std::map<std::string, std::int64_t> counts() const;

  std::vector<std::byte> save() const;
  /// Takes up what save() gave. Fails if the bytes belong to another plan; the object is then of no more use.
  Result<void> restore(std::span<const std::byte> bytes);

 private:
  struct Timed {
    const MeasurementKind* kind;
    Cadence cadence;
    std::unique_ptr<Measurement> measurement;
    std::int64_t samples = 0;
  };

  /// What is measured of the rods of one species.
  struct OfSpecies {
    std::size_t species;
    std::string prefix;  ///< of names of what is found: "", "rods_2"
    bool has_axis;
    std::vector<Timed> timed{};
    const MeasuredOrder* order = nullptr;      ///< one of `timed`, or null
    const MeasuredDefects* defects = nullptr;  ///< the same
  };
  /// The reduction of one species, whose names have no prefix yet.
  Reduction reduce(const OfSpecies& rods, std::optional<double> t_steady, double sim_seconds) const;
  /// What saved states call it: "order", "rods_2/order".
  static std::string tag(const OfSpecies& rods, const Timed& timed);

  Cell cell_;
  std::optional<double> steady_;
  std::vector<OfSpecies> species_;           ///< the first species first
  std::map<std::string_view, double> over_;  ///< of each number the time over which it is taken [s] (Output::over)
};

}  // namespace shaken::run
