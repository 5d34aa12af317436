#include "analysis/temperatures.h"

#include <array>
#include <string>
#include <utility>

#include "analysis/errors/blocked.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

using analysis::Freedom;

constexpr std::array<std::pair<Freedom, const char*>, analysis::kFreedoms> kFreedomNames{{
    {Freedom::kHorizontal, "horizontal"},
    {Freedom::kVertical, "vertical"},
    {Freedom::kAlong, "along"},
    {Freedom::kAcross, "across"},
    {Freedom::kTurning, "turning"},
    {Freedom::kTipping, "tipping"},
    {Freedom::kSpinning, "spinning"},
    {Freedom::kRotation, "rotation"},
}};

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
    const auto means = block_estimates(statistics, result.t_steady, [](const analysis::TemperatureStatistics& part) {
      const analysis::Temperatures found = part.reduce();
      std::vector<double> numbers(found.begin(), found.end());
      const analysis::Speeds speeds = part.speeds();
      numbers.insert(numbers.end(), {speeds.rms, speeds.mean});
      return numbers;
    });
    result.scalars["speed_rms_mm_s"] = means[analysis::kFreedoms];
    result.scalars["speed_mean_mm_s"] = means[analysis::kFreedoms + 1];
    result.arrays["/temperatures/time_s"] = series.times();
    for (const auto& [freedom, name] : kFreedomNames) {
      result.arrays[std::string("/temperatures/") + name + "_pJ"] = series.of(freedom);
      result.scalars[std::string("temperature_") + name + "_pJ"] = means[static_cast<std::size_t>(freedom)];
    }
  };
  return measured(sample, reduce, analysis::TemperatureSeries(), analysis::Blocked(analysis::TemperatureStatistics()));
}

}  // namespace

MeasurementKind temperatures_kind() {
  return {
      .name = "temperatures",
      .sources = "temperatures",
      .make = measure_temperatures,
      .arrays =
          {
              called("time", "t",
                     {"time_s", "times of T(t); of more than 65,536 samples, each point is a mean of several"}),
              called("temperature in the plane", R"(T_\mathrm{h})",
                     {"horizontal_pJ", "T(t) of translation in the plane"}),
              {"vertical_pJ", "of vertical translation"},
              {"along_pJ", "of translation along the rod, in the plane"},
              {"across_pJ", "of that across it"},
              {"turning_pJ", "of rotation in the plane"},
              {"tipping_pJ", "of rotation out of the plane"},
              {"spinning_pJ", "of rotation about the rod's own axis"},
              called("temperature of rotation", R"(T_\mathrm{r})",
                     {"rotation_pJ", "of rotation, mean over three axes"}),
          },
      .numbers =
          {
              called("temperature in the plane", R"(T_\mathrm{h})",
                     {"temperature_horizontal_pJ", "granular temperature of translation in the plane, m⟨δv²⟩/2"}),
              called("vertical temperature", "T_z", {"temperature_vertical_pJ", "of vertical translation"}),
              called("temperature along the rods", "T_∥",
                     {"temperature_along_pJ", "of translation along the rod, in the plane"}),
              called("temperature across the rods", "T_⊥", {"temperature_across_pJ", "of that across it"}),
              {"temperature_turning_pJ", "of rotation in the plane"},
              {"temperature_tipping_pJ", "of rotation out of the plane"},
              {"temperature_spinning_pJ", "of rotation about the rod's own axis"},
              called("temperature of rotation", R"(T_\mathrm{r})",
                     {"temperature_rotation_pJ", "of rotation, mean over three axes"}),
              called("rms speed", R"(v_\mathrm{rms})",
                     {"speed_rms_mm_s", "√⟨v²⟩ in the plane, of velocities of instants"}),
              called("mean speed", R"(\langle|v|\rangle)",
                     {"speed_mean_mm_s", "⟨|v|⟩ in the plane, of velocities of instants"}),
          },
      .of_axis = {"along_pJ", "across_pJ", "turning_pJ", "tipping_pJ", "spinning_pJ", "temperature_along_pJ",
                  "temperature_across_pJ", "temperature_turning_pJ", "temperature_tipping_pJ",
                  "temperature_spinning_pJ"},
      .needs = {Needs::kSpins, Needs::kVelocities},
  };
}

}  // namespace shaken::run
