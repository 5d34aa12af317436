// SPDX-License-Identifier: MIT
#include "analysis/tilt.h"

#include <algorithm>

#include "analysis/blocked.h"
#include "analysis/tilt_summary.h"
#include "run/measure/estimates.h"
#include "run/measure/largest_tilt.h"
#include "run/measure/registry.h"

namespace shaken::run {
namespace {

class MeasuredTilt : public Measurement {
 public:
  MeasuredTilt(int bins, double n_z_max) : tilt_(analysis::TiltVelocity(bins, n_z_max)) {}

  void sample(const Moment& moment) override { tilt_.accumulate(moment->time, moment->director, moment->velocity); }
  void reduce(Reduction& result) const override {
    const analysis::TiltCurve curve = tilt_.after(result.t_steady).reduce();
    result.arrays["/tilt/n_z"] = curve.n_z;
    result.arrays["/tilt/v_along_mm_s"] = curve.v_along;
    result.arrays["/tilt/v_along_sem_mm_s"] = curve.v_along_sem;
    result.arrays["/tilt/v_across_mm_s"] = curve.v_across;
    result.arrays["/tilt/v_across_sem_mm_s"] = curve.v_across_sem;
    result.arrays["/tilt/density"] = curve.density;
    const analysis::FoldedTilt folded = analysis::fold_tilt(curve);
    result.arrays["/tilt/folded/n_z"] = folded.n_z;
    put(result, "/tilt/folded/v_along", "_mm_s", folded.v_along);
    const analysis::TiltSummary summary = analysis::summarize_tilt(curve);
    result.scalars["tilt_fastest_mm_s"] = scalar(summary.v_largest);
    result.scalars["tilt_fastest_n_z"] = {summary.n_z_largest};
    result.scalars["tilt_reversal_n_z"] = {summary.n_z_zero};
    result.scalars["tilt_reversal_sigmas"] = {summary.zero_sigma};
  }
  void save(analysis::StateWriter& writer) const override { tilt_.save(writer); }
  void restore(analysis::StateReader& reader) override { tilt_.restore(reader); }

 private:
  analysis::Blocked<analysis::TiltVelocity> tilt_;
};

}  // namespace

std::unique_ptr<Measurement> make_tilt(const MeasureContext& context) {
  // Soft overlaps let rods tilt a little further; a gap that lets them stand gives the whole range.
  const double n_z_max = std::max(largest_tilt(context.species, context.plan.system.gap), 1e-6);
  return std::make_unique<MeasuredTilt>(context.plan.tilt->bins, n_z_max);
}

}  // namespace shaken::run
