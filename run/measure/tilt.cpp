#include "analysis/tilt.h"

#include <algorithm>

#include "analysis/errors/blocked.h"
#include "analysis/tilt_summary.h"
#include "analysis/tilt_switches.h"
#include "run/measure/estimates.h"
#include "run/measure/largest_tilt.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

std::unique_ptr<Measurement> measure_tilt(const MeasureContext& context) {
  // Soft overlaps let rods tilt a little further; a gap that lets them stand gives the whole range.
  double n_z_max = 1e-6;
  for (const Species& size : context.sizes) n_z_max = std::max(n_z_max, largest_tilt(size, context.plan.system.gap));
  const auto sample = [](const Sample& now, auto& tilt, auto& switches) {
    tilt.accumulate(now->time, now->director, now->velocity);
    switches.accumulate(now->time, now->director);
  };
  const auto reduce = [](Reduction& result, const auto& tilt, const auto& switches) {
    const std::vector<analysis::TiltVelocity> blocks = tilt.parts_after(result.t_steady, analysis::kMostParts);
    const analysis::TiltCurve curve = analysis::TiltVelocity::reduce(tilt.empty(), blocks);
    result.arrays["/tilt/n_z"] = curve.n_z;
    result.arrays["/tilt/v_along_mm_s"] = curve.v_along;
    result.arrays["/tilt/v_along_sem_mm_s"] = curve.v_along_sem;
    result.arrays["/tilt/v_across_mm_s"] = curve.v_across;
    result.arrays["/tilt/v_across_sem_mm_s"] = curve.v_across_sem;
    result.arrays["/tilt/density"] = curve.density;
    const analysis::TiltSummary summary = analysis::summarize_tilt(tilt.empty(), blocks);
    result.arrays["/tilt/folded/n_z"] = summary.folded.n_z;
    put(result, "/tilt/folded/v_along", "_mm_s", summary.folded.v_along);
    result.scalars["n_z_switching_time_s"] =
        block_estimates(switches.sums(), result.t_steady, [](const analysis::SwitchSums& sums) {
          return std::vector<double>{analysis::TiltSwitches::switching_time(sums)};
        })[0];
    result.scalars["tilt_fastest_mm_s"] = scalar(summary.v_largest);
    result.scalars["tilt_fastest_n_z"] = scalar(summary.n_z_largest);
    result.scalars["tilt_reversal_n_z"] = scalar(summary.n_z_zero);
    result.scalars["tilt_reversal_sigmas"] = {{summary.zero_sigma}};
  };
  return measured(sample, reduce, analysis::Blocked(analysis::TiltVelocity(context.plan.tilt->bins, n_z_max)),
                  analysis::TiltSwitches(n_z_max / 2));
}

}  // namespace

MeasurementKind tilt_kind() {
  return {
      .name = "tilt",
      .sources = "tilt, tilt_summary, tilt_switches",
      .make = measure_tilt,
      .arrays =
          {
              called("tilt of a rod", "n_z", {"n_z", "bin centres of the vertical component of the axis"}),
              called("velocity along the rod", R"(\langle v_∥\rangle)",
                     {"v_along_mm_s", "mean of velocities of instants along the rod's own direction in the plane",
                      kWithError}),
              called("velocity across the rod", R"(\langle v_⊥\rangle)",
                     {"v_across_mm_s", "across that direction, to the left", kWithError}),
              {"density", "P(n_z)"},
              {"folded/n_z", "bins with n_z > 0"},
              {"folded/v_along_mm_s", "both signs of n_z combined, with v(-n_z) = -v(n_z)", kWithError},
          },
      .numbers =
          {
              {"n_z_switching_time_s", "mean time for which a rod stays tilted to one side"},
              {"tilt_fastest_mm_s",
               "folded mean of velocities of instants along the rod where its magnitude is largest, over bins with 1 % "
               "of the samples at least; negative: away "
               "from the "
               "raised end",
               false, "no mean velocity differs from 0 by three of its errors"},
              {"tilt_fastest_n_z", "tilt at which it is reached", false,
               "no mean velocity differs from 0 by three of its errors"},
              {"tilt_reversal_n_z", "tilt at which the folded mean velocity changes sign", false,
               "the mean velocity does not change its sign beyond its largest value"},
              {"tilt_reversal_sigmas",
               "significance of the reversal: mean velocity beyond that tilt over its error, positive if reversed; "
               "below about 3 none is seen",
               false, "the mean velocity does not change its sign beyond its largest value"},
          },
      .needs = {Needs::kTilts, Needs::kVelocities, Needs::kIdentities},
  };
}

}  // namespace shaken::run
