// SPDX-License-Identifier: MIT
#include <algorithm>

#include "analysis/blocked.h"
#include "analysis/director_fluctuations.h"
#include "run/measure/estimates.h"
#include "run/measure/registry.h"

namespace shaken::run {
namespace {

class MeasuredFrank : public Measurement {
 public:
  MeasuredFrank(double box_side, double q_max) : waves_(analysis::DirectorFluctuations(box_side, q_max)) {}

  void sample(const Moment& moment) override { waves_.accumulate(moment->time, moment->position, moment->director); }
  void reduce(Reduction& result) const override {
    const analysis::DirectorSpectrum spectrum = analysis::DirectorFluctuations::reduce(waves_, result.t_steady);
    result.arrays["/frank/q_along_per_mm"] = spectrum.q_along;
    result.arrays["/frank/q_across_per_mm"] = spectrum.q_across;
    result.arrays["/frank/fit_mm2"] = spectrum.fit;
    put(result, "/frank/power", "_mm2", spectrum.power);
    result.scalars["frank_ratio"] = scalar(spectrum.ratio);
    result.scalars["frank_splay"] = scalar(spectrum.splay);
    result.scalars["frank_bend"] = scalar(spectrum.bend);
    result.scalars["frank_chi2"].value = spectrum.chi2;
    result.scalars["frank_floor_mm2"].value = spectrum.floor;
  }
  void save(analysis::StateWriter& writer) const override { waves_.save(writer); }
  void restore(analysis::StateReader& reader) override { waves_.restore(reader); }

 private:
  analysis::Blocked<analysis::DirectorFluctuations> waves_;
};

}  // namespace

std::unique_ptr<Measurement> make_frank(const MeasureContext& context) {
  const Scene& system = context.plan.system;
  // Elasticity is of waves long against a rod, three of them at least; the four longest of the box are always taken.
  const double three_rods = 2 * kPi / (3 * system.rod.length);
  const double longest = 2 * kPi / system.box_side * 1.5;
  return std::make_unique<MeasuredFrank>(system.box_side, std::max(three_rods, longest));
}

}  // namespace shaken::run
