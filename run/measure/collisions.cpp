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

constexpr std::array<std::pair<CollisionCount, const char*>, analysis::kCollisionCounts> kCollisionNames{{
    {CollisionCount::kRodRod, "impacts_rods_Hz"},
    {CollisionCount::kBase, "impacts_base_Hz"},
    {CollisionCount::kLid, "impacts_lid_Hz"},
    {CollisionCount::kWalls, "impacts_walls_Hz"},
    {CollisionCount::kGiven, "power_given_pJ_s"},
    {CollisionCount::kLostRodRod, "power_lost_rods_pJ_s"},
    {CollisionCount::kLostSurfaces, "power_lost_surfaces_pJ_s"},
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
    for (const auto& [count, name] : kCollisionNames) {
      result.arrays[std::string("/collisions/") + name] = series.of(count);
      result.scalars[name] = numbers[static_cast<std::size_t>(count)];
    }
    result.scalars["mean_free_time_s"] = numbers.back();
  };
  return measured(sample, reduce, analysis::CollisionSeries());
}

}  // namespace

MeasurementKind collisions_kind() {
  return {
      .name = "collisions",
      .sources = "collision_rates",
      .make = measure_collisions,
      .arrays =
          {
              called("time", "t",
                     {"time_s", "ends of the times from one sample to the next, over which the following are means"}),
              {"impacts_rods_Hz", "impacts of one rod with others in a second"},
              {"impacts_base_Hz", "with the base"},
              {"impacts_lid_Hz", "with the lid"},
              {"impacts_walls_Hz", "with side walls"},
              called("power given to a rod", "P",
                     {"power_given_pJ_s", "energy that plates, walls and noise give to one rod in a second"}),
              {"power_lost_rods_pJ_s", "energy that one rod loses in impacts with others in a second"},
              {"power_lost_surfaces_pJ_s", "energy that it loses in impacts with plates and walls"},
          },
      .numbers =
          {
              {"impacts_rods_Hz", "impacts of one rod with others in a second"},
              {"impacts_base_Hz", "with the base"},
              {"impacts_lid_Hz", "with the lid"},
              {"impacts_walls_Hz", "with side walls"},
              called("power given to a rod", "P",
                     {"power_given_pJ_s", "energy that plates, walls and noise give to one rod in a second"}),
              {"power_lost_rods_pJ_s", "energy that one rod loses in impacts with others in a second"},
              {"power_lost_surfaces_pJ_s", "energy that it loses in impacts with plates and walls"},
              called("mean free time", R"(τ_\mathrm{f})",
                     {"mean_free_time_s", "mean time of a rod between impacts with others: 1 / `impacts_rods_Hz`",
                      false, "no impacts of rods with each other"}),
          },
      .needs = {Needs::kImpacts},
  };
}

}  // namespace shaken::run
