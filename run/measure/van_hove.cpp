// SPDX-License-Identifier: MIT
#include "analysis/van_hove.h"

#include <optional>

#include "analysis/steady.h"
#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredVanHove : public Measurement {
 public:
  MeasuredVanHove(const analysis::VanHove& empty, std::optional<double> steady) : steady_(steady), van_hove_(empty) {}

  void sample(const Sample& sample) override {
    if (!analysis::is_steady(sample->time, steady_.value_or(0.0))) return;
    van_hove_.accumulate(sample->time, sample.unwrapped(), sample.order().director);
  }
  void reduce(Reduction& result) const override {
    const double from = steady_.value_or(result.t_steady);
    // Rows by lag, one behind the other.
    std::vector<double> lags, displacements;
    analysis::EstimateCurve along, across, distance;
    for (std::size_t k = 0; k < van_hove_.n_lags(); ++k) {
      const auto& samples = van_hove_.displacements(k);
      lags.push_back(van_hove_.lag(k));
      const std::vector<double> centres = samples.empty().reduce().displacement;
      displacements.insert(displacements.end(), centres.begin(), centres.end());
      const auto points = block_estimates(samples, from, [](const analysis::DisplacementHistogram& part) {
        const analysis::DisplacementCurve found = part.reduce();
        std::vector<double> all = found.along;
        all.insert(all.end(), found.across.begin(), found.across.end());
        all.insert(all.end(), found.distance.begin(), found.distance.end());
        all.push_back(found.beyond);
        return all;
      });
      const std::size_t bins = centres.size();
      for (std::size_t i = 0; i < 3 * bins; ++i) {
        (i < bins ? along : i < 2 * bins ? across : distance).push_back(points[i]);
      }
      result.scalars["van_hove_beyond"] = points.back();
    }
    result.arrays["/van_hove/lag_s"] = lags;
    result.arrays["/van_hove/displacement_mm"] = displacements;
    put(result, "/van_hove/along", "_per_mm", along);
    put(result, "/van_hove/across", "_per_mm", across);
    put(result, "/van_hove/distance", "_per_mm", distance);
  }
  void save(StateWriter& writer) const override { van_hove_.save(writer); }
  void restore(StateReader& reader) override { van_hove_.restore(reader); }

 private:
  std::optional<double> steady_;  ///< [s]; given, it leaves out what is before, or else the reduction does
  analysis::VanHove van_hove_;
};

}  // namespace

MeasurementKind van_hove_kind() {
  return {
      .name = "van_hove",
      .sources = "van_hove",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        const scene::MeasureVanHove& settings = *context.plan.van_hove;
        const double range = settings.range_for(context.plan.system.rod.length);
        return std::make_unique<MeasuredVanHove>(
            analysis::VanHove(context.interval, settings.lag, settings.bins, range), context.plan.steady);
      },
      .arrays =
          {
              {"lag_s", "(lags) lags, at most four"},
              {"displacement_mm", "(lags · bins) bin centres of x, whose sign does not count, row by row"},
              {"along_per_mm", "(lags · bins) G_s(x, t) of displacements x along the director", kWithError},
              {"across_per_mm", "(lags · bins) of those across it", kWithError},
              {"distance_per_mm", "(lags · bins) density 2πr G_s(r, t) of the distance r in the plane", kWithError},
          },
      .numbers =
          {
              over("lag", {"van_hove_beyond", "share of the displacements that lie beyond the range"}),
          },
      .of_axis = {"along_per_mm", "across_per_mm"},
  };
}

}  // namespace shaken::run
