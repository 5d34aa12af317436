#include "analysis/angles.h"

#include <optional>
#include <string>

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::AnglePdf;
using analysis::TwoPeaks;

constexpr std::array kAnglePdf{
    from<&AnglePdf::theta>(called("angle to the director", "θ", {"theta_rad", "bin centres over [-π/2, π/2)"})),
    from<&AnglePdf::density>(
        called("probability density", "P(θ)", {"density_per_rad", "P(θ) about the director, of integral 1"})),
};
constexpr std::array kAnglePeaks{
    from<[](const TwoPeaks& peaks) { return peaks.theta_m * 180 / kPi; }>(
        called("tilt of the layers", R"(θ_\mathrm{m})",
               {"theta_m_deg",
                "angle by which layers are turned: ± the means of two Gaussians fitted to P(θ); null if there is "
                "one peak",
                false, "P(theta) has one peak, or too few samples to tell two"})),
    from<[](const TwoPeaks& peaks) { return peaks.maximum * 180 / kPi; }>(
        {"theta_m_maximum_deg",
         "angle at which P(θ) itself is highest, both signs taken together; null if there is one peak", false,
         "P(theta) has one peak, or too few samples to tell two"}),
};
constexpr std::array kAngleDip{
    from<&TwoPeaks::dip>({"dip", "P(0) over the maximum of P: below 1 where there are two peaks"}),
};

/// P(theta), and theta_m where it has two peaks.
std::unique_ptr<Measurement> measure_angles(const MeasureContext& context) {
  const auto sample = [](const Sample& now, auto& angles) { angles.accumulate(now->time, now->director); };
  const auto reduce = [](Reduction& result, const auto& angles) {
    put(result, "/angles/", kAnglePdf, angles.after(result.t_steady).reduce());
    const auto peaks_of = [](const analysis::AngleDistribution& part) {
      constexpr double kNone = analysis::kNaN;
      const std::optional<TwoPeaks> found = analysis::fit_two_peaks(part.reduce());
      return found.value_or(TwoPeaks{.theta_m = kNone, .dip = kNone, .maximum = kNone});
    };
    put(result, "", kAnglePeaks, angles, peaks_of);
    put(result, "", kAngleDip, angles, peaks_of);
    if (analysis::are_two(result.scalars[std::string(kAngleDip[0].name)])) return;
    for (const auto& row : kAnglePeaks) result.scalars[std::string(row.name)] = {};
  };
  return measured(sample, reduce, analysis::Blocked(analysis::AngleDistribution(context.plan.angles->bins)));
}

}  // namespace

MeasurementKind angles_kind() {
  return {
      .name = "angles",
      .sources = "angles",
      .make = measure_angles,
      .arrays = outputs_of(kAnglePdf),
      .numbers = outputs_of(kAnglePeaks, kAngleDip),
  };
}

}  // namespace shaken::run
