#include "scene/keys/accuracy_levels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace shaken::scene {
namespace {

// Measured with rods of 4.5 mm at area fraction 0.75: rows of docs/data/accuracy-bias.csv, which docs/accuracy.md
// explains.
constexpr std::array<Bias, 5> kDraftBias{{{"order", -0.08, 0.53, "%"},
                                          {"temperature in the plane", 0.19, 0.18, "%"},
                                          {"temperature upright", 0.00, 0.09, "%"},
                                          {"square displacement in 20.7 ms", 0.24, 0.28, "%"},
                                          {"rods just hit", 7.63, 0.30, "%"}}};
constexpr std::array<Bias, 5> kDeskBias{{{"order", 0.43, 0.48, "%"},
                                         {"temperature in the plane", 0.13, 0.18, "%"},
                                         {"temperature upright", 0.10, 0.09, "%"},
                                         {"square displacement in 20.7 ms", 0.15, 0.30, "%"},
                                         {"rods just hit", 3.50, 0.29, "%"}}};
constexpr std::array<Bias, 5> kPaperBias{{{"order", 0.73, 0.52, "%"},
                                          {"temperature in the plane", -0.17, 0.18, "%"},
                                          {"temperature upright", 0.18, 0.08, "%"},
                                          {"square displacement in 20.7 ms", -0.26, 0.29, "%"},
                                          {"rods just hit", 0.73, 0.28, "%"}}};
constexpr std::array<Bias, 5> kFineBias{{{"order", 0.23, 0.38, "%"},
                                         {"temperature in the plane", -0.17, 0.18, "%"},
                                         {"temperature upright", 0.06, 0.08, "%"},
                                         {"square displacement in 20.7 ms", -0.18, 0.28, "%"},
                                         {"rods just hit", -0.01, 0.27, "%"}}};

// The cheapest settings measured that keep averages ("fine": rods just hit too) within their bounds; "paper" is given.
constexpr std::array<AccuracyLevel, 4> kLevels{{
    {"draft", "For a first look: is there order, do the parameters make sense.", 32e-6, ImpactTime::kTickEnd, 1.2, 8.3,
     0.58, kDraftBias},
    {"desk", "For the cheapest averages within 1 %, except contact statistics.", 16e-6, ImpactTime::kTickEnd, 1, 4.2,
     0.649, kDeskBias},
    {"paper", "As in Sharma & Soni (2024): for results to be compared with theirs.", 4e-6, ImpactTime::kTickEnd, 0.9,
     1.6, 1.0, kPaperBias},
    {"fine", "For contacts and trajectories, and to see what the step does to a result.", 2e-6, ImpactTime::kAtInstant,
     0.8, 0.8, 1.83, kFineBias},
}};

}  // namespace

std::span<const AccuracyLevel> accuracy_levels() { return kLevels; }

double relative_cost(double step, ImpactTime impacts) {
  for (const AccuracyLevel& level : kLevels) {
    if (level.step == step && level.impacts == impacts) return level.cost;
  }
  if (impacts == ImpactTime::kAtInstant) {
    const AccuracyLevel& fine = kLevels.back();
    return fine.cost / relative_cost(fine.step, ImpactTime::kTickEnd) * relative_cost(step, ImpactTime::kTickEnd);
  }
  const bool coarse = step > kLevels[1].step;  // the levels are sorted, and all but "fine" are of the tick's end
  const AccuracyLevel &a = kLevels[coarse ? 0 : 1], &b = kLevels[coarse ? 1 : 2];
  const double slope = std::log(b.cost / a.cost) / std::log(b.step / a.step);
  return a.cost * std::pow(step / a.step, slope);
}

const AccuracyLevel* accuracy_level(std::string_view name) {
  const auto found =
      std::find_if(kLevels.begin(), kLevels.end(), [&](const auto& level) { return level.name == name; });
  return found == kLevels.end() ? nullptr : &*found;
}

const AccuracyLevel* accuracy_level(const System& system) {
  const auto found = std::find_if(kLevels.begin(), kLevels.end(), [&](const auto& level) {
    return level.step == system.dt && level.impacts == system.impacts;
  });
  return found == kLevels.end() ? nullptr : &*found;
}

}  // namespace shaken::scene
