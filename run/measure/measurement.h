#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "analysis/collision_rates.h"
#include "analysis/order.h"
#include "analysis/stress.h"
#include "base/core/state_io.h"
#include "run/measure/reduction.h"
#include "scene/keys/run_plan.h"
#include "sim/cell.h"
#include "sim/rod/species.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// Totals of all rods of a run, whatever their species, up to a tick.
struct RunTotals {
  analysis::CollisionTotals collisions{};
  analysis::StressTotals stress{};
};

/// The measured rods at one tick, with what several measurements need of them, worked out once and only on demand.
class Sample {
 public:
  /// A sample of the measured `rods` among `all`, which must outlive it.
  Sample(const Snapshot& rods, const Snapshot& all, const RunTotals& totals)
      : rods_(rods), all_(all), totals_(totals) {}

  const Snapshot* operator->() const { return &rods_; }
  /// Rods of all species.
  const Snapshot& all() const { return all_; }
  const RunTotals& totals() const { return totals_; }
  /// Nematic order and director of all rods.
  const analysis::NematicOrder& order() const {
    if (!order_) order_ = analysis::nematic_order(rods_.director);
    return *order_;
  }
  /// Centres without the jumps at the borders of the box [mm], of rods that are followed (Snapshot::by_track).
  const std::vector<Vec3>& unwrapped() const {
    if (unwrapped_.empty()) {
      for (std::size_t i = 0; i < rods_.n_rods(); ++i) unwrapped_.push_back(rods_.unwrapped(i));
      unwrapped_ = rods_.by_track(std::move(unwrapped_));
    }
    return unwrapped_;
  }

 private:
  const Snapshot& rods_;
  const Snapshot& all_;
  RunTotals totals_;
  mutable std::optional<analysis::NematicOrder> order_;
  mutable std::vector<Vec3> unwrapped_;
};

/// One observable of a run: what stands between a snapshot and the accumulators of analysis/.
class Measurement {
 public:
  virtual ~Measurement() = default;

  /// Called when a sample is due (MeasurementKind::cadence).
  virtual void sample(const Sample& sample) = 0;
  /// Adds arrays and scalars of the steady state, which begins at result.t_steady.
  virtual void reduce(Reduction& result) const = 0;

  virtual void save(StateWriter& writer) const = 0;
  /// Throws StateError if the bytes are not of such a measurement.
  virtual void restore(StateReader& reader) = 0;
};

/// What a measurement may know of its run when it is made.
struct MeasureContext {
  const scene::RunPlan& plan;         ///< of the rods that are measured
  const scene::RunPlan& run;          ///< of all species
  const Species& species;             ///< the mean rod of those that are measured
  const Cell& cell;                   ///< which rod is of which shape
  double interval;                    ///< between its samples: a whole number of ticks [s]
  std::size_t number;                 ///< of the species that is measured, in the cell
  const std::vector<Species>& sizes;  ///< of the rods that are measured, the mean one in front

  /// `value(size)` for each rod that is measured; one value if all are of one size.
  template <class Value>
  auto of_rods(const Value& value) const {
    if (sizes.size() == 1) return std::vector{value(sizes.front())};
    const std::size_t first = cell.first_shape_of(number);
    std::vector<decltype(value(sizes.front()))> values;
    for (const std::uint8_t shape : cell.of_species(number, cell.shape_of_rod))
      values.push_back(value(sizes[shape - first]));
    return values;
  }
};

}  // namespace shaken::run
