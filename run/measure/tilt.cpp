#include "analysis/tilt.h"

#include <algorithm>

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::FoldedTilt;
using analysis::TiltCurve;
using analysis::TiltSummary;

constexpr std::array kTiltCurves{
    from<[](const TiltCurve& curve) { return curve.n_z; }>(
        called("tilt of a rod", "n_z", {"n_z", "bin centres of the vertical component of the axis"})),
    from<[](const TiltCurve& curve) {
      return analysis::EstimateCurve{curve.v_along, curve.v_along_sem};
    }>(called("velocity along the rod", R"(\langle v_∥\rangle)",
              {"v_along_mm_s", "mean of velocities of instants along the rod's own direction in the plane"})),
    from<[](const TiltCurve& curve) {
      return analysis::EstimateCurve{curve.v_across, curve.v_across_sem};
    }>(called("velocity across the rod", R"(\langle v_⊥\rangle)",
              {"v_across_mm_s", "across that direction, to the left"})),
    from<[](const TiltCurve& curve) { return curve.density; }>({"density", "P(n_z)"}),
};
constexpr std::array kTiltFolded{
    from<&FoldedTilt::n_z>({"folded/n_z", "bins with n_z > 0"}),
    from<&FoldedTilt::v_along>({"folded/v_along_mm_s", "both signs of n_z combined, with v(-n_z) = -v(n_z)"}),
};
constexpr std::array kTiltSwitching{
    from<analysis::TiltSwitches::switching_time>(
        {"n_z_switching_time_s", "mean time for which a rod stays tilted to one side"}),
};
constexpr std::array kTiltNumbers{
    from<&TiltSummary::v_largest>(
        {"tilt_fastest_mm_s",
         "folded mean of velocities of instants along the rod where its magnitude is largest, over bins with 1 % "
         "of the samples at least; negative: away from the raised end",
         false, "no mean velocity differs from 0 by three of its errors"}),
    from<&TiltSummary::n_z_largest>({"tilt_fastest_n_z", "tilt at which it is reached", false,
                                     "no mean velocity differs from 0 by three of its errors"}),
    from<&TiltSummary::n_z_zero>({"tilt_reversal_n_z", "tilt at which the folded mean velocity changes sign", false,
                                  "the mean velocity does not change its sign beyond its largest value"}),
    from<&TiltSummary::zero_sigma>(
        {"tilt_reversal_sigmas",
         "significance of the reversal: mean velocity beyond that tilt over its error, positive if reversed; "
         "below about 3 none is seen",
         false, "the mean velocity does not change its sign beyond its largest value"}),
};

std::unique_ptr<Measurement> measure_tilt(const MeasureContext& context) {
  // Soft overlaps let rods tilt a little further; a gap that lets them stand gives the whole range.
  double n_z_max = 1e-6;
  for (const Species& size : context.sizes) {
    n_z_max = std::max(n_z_max, analysis::largest_tilt(size.half_length, size.end_radius, context.plan.system.gap));
  }
  const auto sample = [](const Sample& now, auto& tilt, auto& switches) {
    tilt.accumulate(now->time, now->director, now->velocity);
    switches.accumulate(now->time, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& tilt, const auto& switches) {
    const std::vector<analysis::TiltVelocity> blocks = tilt.parts_after(result.t_steady, analysis::kMostParts);
    const TiltSummary summary = analysis::summarize_tilt(tilt.empty(), blocks);
    put(result, "/tilt/", kTiltCurves, analysis::TiltVelocity::reduce(tilt.empty(), blocks));
    put(result, "/tilt/", kTiltFolded, summary.folded);
    put(result, "", kTiltSwitching, switches.sums(), [](const analysis::SwitchSums& sums) { return sums; });
    put(result, "", kTiltNumbers, summary);
  };
  return measured(sample, reduce, analysis::Blocked(analysis::TiltVelocity(context.plan.tilt->bins, n_z_max)),
                  analysis::TiltSwitches(n_z_max / 2));
}

}  // namespace

MeasurementKind tilt_kind() {
  return {
      .name = "tilt",
      .sources = "tilt",
      .make = measure_tilt,
      .arrays = outputs_of(kTiltCurves, kTiltFolded),
      .numbers = outputs_of(kTiltSwitching, kTiltNumbers),
      .needs = {Needs::kTilts, Needs::kVelocities, Needs::kIdentities, Needs::kEveryRod},
  };
}

}  // namespace shaken::run
