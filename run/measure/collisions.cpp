#include <array>
#include <string>
#include <utility>

#include "analysis/collision_rates.h"
#include "run/measure/estimates.h"
#include "run/measure/measured.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

using analysis::CollisionCount;

struct Rate {
  CollisionCount count;
  Output output;
};
constexpr std::array<Rate, analysis::kCollisionCounts> kRates{{
    {CollisionCount::kRodRod, {"impacts_rods_Hz", "impacts of one rod with others in a second"}},
    {CollisionCount::kBase, {"impacts_base_Hz", "with the base"}},
    {CollisionCount::kLid, {"impacts_lid_Hz", "with the lid"}},
    {CollisionCount::kWalls, {"impacts_walls_Hz", "with side walls"}},
    {CollisionCount::kGiven,
     called("power given to a rod", "P",
            {"power_given_pJ_s", "energy that plates, walls and noise give to one rod in a second"})},
    {CollisionCount::kLostRodRod,
     {"power_lost_rods_pJ_s", "energy that one rod loses in impacts with others in a second"}},
    {CollisionCount::kLostSurfaces,
     {"power_lost_surfaces_pJ_s", "energy that it loses in impacts with plates and walls"}},
}};

std::unique_ptr<Measurement> measure_collisions(const MeasureContext&) {
  const auto sample = [](const Sample& now, auto& series) { series.accumulate(now->time, now.totals().collisions); };
  const auto reduce = [](Reduction& result, const auto& series) {
    const auto numbers = block_estimates(series.sums(), result.t_steady, [](const analysis::CollisionSums& part) {
      const analysis::CollisionRates rates = part.reduce();
      std::vector<double> all(rates.begin(), rates.end());
      const double of_rods = rates[static_cast<std::size_t>(CollisionCount::kRodRod)];
      all.push_back(of_rods > 0 ? 1 / of_rods : analysis::kNaN);
      return all;
    });
    result.arrays["/collisions/time_s"] = series.times();
    for (const auto& [count, output] : kRates) {
      result.arrays["/collisions/" + std::string(output.name)] = series.of(count);
      result.scalars[std::string(output.name)] = numbers[static_cast<std::size_t>(count)];
    }
    result.scalars["mean_free_time_s"] = numbers.back();
  };
  return measured(sample, reduce, analysis::CollisionSeries());
}

}  // namespace

MeasurementKind collisions_kind() {
  MeasurementKind kind{
      .name = "collisions",
      .sources = "collision_rates",
      .make = measure_collisions,
      .arrays = {called(
          "time", "t",
          {"time_s", "ends of the times from one sample to the next, over which the following are means"})},
      .needs = {Needs::kImpacts},
  };
  for (const Rate& rate : kRates) {
    kind.arrays.push_back(rate.output);
    kind.numbers.push_back(rate.output);
  }
  kind.numbers.push_back(
      called("mean free time", R"(τ_\mathrm{f})",
             {"mean_free_time_s", "mean time of a rod between impacts with others: 1 / `impacts_rods_Hz`", false,
              "no impacts of rods with each other"}));
  return kind;
}

}  // namespace shaken::run
