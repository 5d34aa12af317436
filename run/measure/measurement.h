#pragma once

#include "base/core/state_io.h"
#include "run/measure/reduction.h"
#include "run/measure/sample.h"
#include "scene/keys/run_plan.h"
#include "sim/cell.h"
#include "sim/rod/species.h"

namespace shaken::run {

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
