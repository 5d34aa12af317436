#include "analysis/temperatures.h"

#include "run/measure/measured.h"
#include "run/measure/rows.h"

namespace shaken::run {
namespace {

using analysis::Freedom;
using analysis::TemperatureSeries;

struct TemperatureMeans {
  analysis::Temperatures temperatures;
  analysis::Speeds speeds;
};

template <Freedom kFreedom>
std::vector<double> series_of(const TemperatureSeries& series) {
  return series.of(kFreedom);
}
template <Freedom kFreedom>
double mean_of(const TemperatureMeans& means) {
  return means.temperatures[static_cast<std::size_t>(kFreedom)];
}

constexpr std::array kTemperatureSeries{
    from<&TemperatureSeries::times>(
        called("time", "t", {"time_s", "times of T(t); of more than 65,536 samples, each point is a mean of several"})),
    from<series_of<Freedom::kHorizontal>>(
        called("temperature in the plane", R"(T_\mathrm{h})", {"horizontal_pJ", "T(t) of translation in the plane"})),
    from<series_of<Freedom::kVertical>>({"vertical_pJ", "of vertical translation"}),
    from<series_of<Freedom::kAlong>>(of_axis({"along_pJ", "of translation along the rod, in the plane"})),
    from<series_of<Freedom::kAcross>>(of_axis({"across_pJ", "of that across it"})),
    from<series_of<Freedom::kTurning>>(of_axis({"turning_pJ", "of rotation in the plane"})),
    from<series_of<Freedom::kTipping>>(of_axis({"tipping_pJ", "of rotation out of the plane"})),
    from<series_of<Freedom::kSpinning>>(of_axis({"spinning_pJ", "of rotation about the rod's own axis"})),
    from<series_of<Freedom::kRotation>>(
        called("temperature of rotation", R"(T_\mathrm{r})", {"rotation_pJ", "of rotation, mean over three axes"})),
};
constexpr std::array kTemperatureNumbers{
    from<mean_of<Freedom::kHorizontal>>(
        called("temperature in the plane", R"(T_\mathrm{h})",
               {"temperature_horizontal_pJ", "granular temperature of translation in the plane, m⟨δv²⟩/2"})),
    from<mean_of<Freedom::kVertical>>(
        called("vertical temperature", "T_z", {"temperature_vertical_pJ", "of vertical translation"})),
    from<mean_of<Freedom::kAlong>>(
        called("temperature along the rods", "T_∥",
               of_axis({"temperature_along_pJ", "of translation along the rod, in the plane"}))),
    from<mean_of<Freedom::kAcross>>(
        called("temperature across the rods", "T_⊥", of_axis({"temperature_across_pJ", "of that across it"}))),
    from<mean_of<Freedom::kTurning>>(of_axis({"temperature_turning_pJ", "of rotation in the plane"})),
    from<mean_of<Freedom::kTipping>>(of_axis({"temperature_tipping_pJ", "of rotation out of the plane"})),
    from<mean_of<Freedom::kSpinning>>(of_axis({"temperature_spinning_pJ", "of rotation about the rod's own axis"})),
    from<mean_of<Freedom::kRotation>>(called("temperature of rotation", R"(T_\mathrm{r})",
                                             {"temperature_rotation_pJ", "of rotation, mean over three axes"})),
    from<[](const TemperatureMeans& means) { return means.speeds.rms; }>(
        called("rms speed", R"(v_\mathrm{rms})", {"speed_rms_mm_s", "√⟨v²⟩ in the plane, of velocities of instants"})),
    from<[](const TemperatureMeans& means) { return means.speeds.mean; }>(called(
        "mean speed", R"(\langle|v|\rangle)", {"speed_mean_mm_s", "⟨|v|⟩ in the plane, of velocities of instants"})),
};

std::unique_ptr<Measurement> measure_temperatures(const MeasureContext& context) {
  const std::vector inertias = context.of_rods([](const Species& rod) {
    return analysis::RodInertia{rod.mass, rod.inertia_perp, rod.inertia_par};
  });
  const auto sample = [inertias](const Sample& now, auto& series, auto& statistics) {
    const analysis::Temperatures found =
        analysis::granular_temperatures(now->director, now->velocity, now->angular_velocity, inertias);
    series.accumulate(now->time, found);
    statistics.accumulate(now->time, found, now->velocity);
  };
  const auto reduce = [](Reduction& result, const auto& series, const auto& statistics) {
    put(result, "/temperatures/", kTemperatureSeries, series);
    put(result, "", kTemperatureNumbers, statistics, [](const analysis::TemperatureStatistics& part) {
      return TemperatureMeans{part.reduce(), part.speeds()};
    });
  };
  return measured(sample, reduce, analysis::TemperatureSeries(), analysis::Blocked(analysis::TemperatureStatistics()));
}

}  // namespace

MeasurementKind temperatures_kind() {
  return {
      .name = "temperatures",
      .sources = "temperatures",
      .make = measure_temperatures,
      .arrays = outputs_of(kTemperatureSeries),
      .numbers = outputs_of(kTemperatureNumbers),

      .needs = {Needs::kSpins, Needs::kVelocities},
  };
}

}  // namespace shaken::run
