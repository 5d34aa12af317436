#include "analysis/angles.h"

#include <limits>
#include <optional>

#include "analysis/two_peaks.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

/// P(theta), and theta_m where it has two peaks.
std::unique_ptr<Measurement> measure_angles(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& angles) { angles.accumulate(now->time, now->director); };
  const auto reduce = [](Reduction& result, const auto& angles) {
    const analysis::AnglePdf pdf = angles.after(result.t_steady).reduce();
    result.arrays["/angles/theta_rad"] = pdf.theta;
    result.arrays["/angles/density_per_rad"] = pdf.density;
    const auto peaks = block_estimates(angles, result.t_steady, [](const analysis::AngleDistribution& part) {
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      const std::optional<analysis::TwoPeaks> found = analysis::fit_two_peaks(part.reduce());
      if (!found) return std::vector<double>{kNone, kNone, kNone};
      return std::vector<double>{found->theta_m * 180 / kPi, found->dip, found->maximum * 180 / kPi};
    });
    const Scalar& dip = peaks[1];
    const bool two = analysis::are_two({dip.value, dip.sem});
    result.scalars["theta_m_deg"] = two ? peaks[0] : Scalar{};
    result.scalars["theta_m_maximum_deg"] = two ? peaks[2] : Scalar{};
    result.scalars["dip"] = dip;
  };
  return measured(sample, reduce, analysis::Blocked(analysis::AngleDistribution(context.plan.angles->bins)));
}

}  // namespace

MeasurementKind angles_kind() {
  return {
      .name = "angles",
      .sources = "angles, two_peaks",
      .make = measure_angles,
      .arrays =
          {
              called("angle to the director", "θ", {"theta_rad", "bin centres over [-π/2, π/2)"}),
              called("probability density", "P(θ)", {"density_per_rad", "P(θ) about the director, of integral 1"}),
          },
      .numbers =
          {
              called("tilt of the layers", R"(θ_\mathrm{m})",
                     {"theta_m_deg",
                      "angle by which layers are turned: ± the means of two Gaussians fitted to P(θ); null if there is "
                      "one "
                      "peak",
                      false, "P(theta) has one peak, or too few samples to tell two"}),
              {"theta_m_maximum_deg",
               "angle at which P(θ) itself is highest, both signs taken together; null if there is one peak", false,
               "P(theta) has one peak, or too few samples to tell two"},
              {"dip", "P(0) over the maximum of P: below 1 where there are two peaks"},
          },
  };
}

}  // namespace shaken::run
