// SPDX-License-Identifier: MIT
#include "analysis/g2.h"

#include "analysis/blocked.h"
#include "analysis/region.h"
#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

class MeasuredG2 : public Measurement {
 public:
  MeasuredG2(int bins, const analysis::Region& region)
      : region_(region), g2_(analysis::OrientationCorrelation(bins, region.box().shorter() / 2)) {}

  void sample(const Sample& sample) override {
    g2_.accumulate(sample->time, sample->position, sample->director, region_);
  }
  void reduce(Reduction& result) const override {
    result.arrays["/g2/r_mm"] = g2_.empty().reduce().r;
    // Both curves one behind the other.
    const auto numbers = block_estimates(g2_, result.t_steady, [](const analysis::OrientationCorrelation& part) {
      analysis::OrientationCurve curve = part.reduce();
      curve.g2.insert(curve.g2.end(), curve.g.begin(), curve.g.end());
      return curve.g2;
    });
    analysis::EstimateCurve g2, g;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      (i < numbers.size() / 2 ? g2 : g).push_back({numbers[i].value, numbers[i].sem});
    }
    put(result, "/g2/g2", "", g2);
    put(result, "/g2/g", "", g);
  }
  void save(StateWriter& writer) const override { g2_.save(writer); }
  void restore(StateReader& reader) override { g2_.restore(reader); }

 private:
  analysis::Region region_;
  analysis::Blocked<analysis::OrientationCorrelation> g2_;
};

}  // namespace

MeasurementKind g2_kind() {
  return {
      .name = "g2",
      .sources = "g2, region",
      .make = [](const MeasureContext& context) -> std::unique_ptr<Measurement> {
        const System& system = context.plan.system;
        return std::make_unique<MeasuredG2>(context.plan.g2->bins, analysis::Region(system.box(), system.walls));
      },
      .arrays =
          {
              {"r_mm", "bin centres"},
              {"g2", "G₂(r)", kWithError},
              {"g", "g(r)", kWithError},
          },
      .of_axis = {"g2"},
  };
}

}  // namespace shaken::run
