// SPDX-License-Identifier: MIT
#include "scene/accuracy.h"

#include <algorithm>
#include <array>

namespace shaken::scene {
namespace {

// Measured with rods of 4.5 mm at area fraction 0.75 (`shaken bench accuracy statistical`; docs/accuracy.md has more).
constexpr std::array<Bias, 5> kDraftBias{{{"order", -0.46, 0.42, "%"},
                                          {"temperature in the plane", -0.14, 0.25, "%"},
                                          {"temperature upright", 0.32, 0.12, "%"},
                                          {"square displacement in 20.7 ms", 0.11, 0.42, "%"},
                                          {"rods just hit", 3.20, 0.40, "%"}}};
constexpr std::array<Bias, 5> kPaperBias{{{"order", 0.68, 0.34, "%"},
                                          {"temperature in the plane", -0.34, 0.26, "%"},
                                          {"temperature upright", 0.39, 0.12, "%"},
                                          {"square displacement in 20.7 ms", -0.40, 0.42, "%"},
                                          {"rods just hit", 0.30, 0.39, "%"}}};
constexpr std::array<Bias, 5> kFineBias{{{"order", -0.38, 0.35, "%"},
                                         {"temperature in the plane", 0.07, 0.25, "%"},
                                         {"temperature upright", 0.02, 0.12, "%"},
                                         {"square displacement in 20.7 ms", 0.35, 0.41, "%"},
                                         {"rods just hit", 0.20, 0.39, "%"}}};

constexpr std::array<AccuracyLevel, 3> kLevels{{
    {"draft", "A first look: is there order, do the parameters make sense.", 16e-6, 0.62, kDraftBias},
    {"paper", "The step of Sharma & Soni (2024): for results to be published.", 4e-6, 1.0, kPaperBias},
    {"fine", "To see what the step does to a result.", 1e-6, 2.4, kFineBias},
}};

}  // namespace

std::span<const AccuracyLevel> accuracy_levels() { return kLevels; }

const AccuracyLevel* accuracy_level(std::string_view name) {
  const auto found =
      std::find_if(kLevels.begin(), kLevels.end(), [&](const auto& level) { return level.name == name; });
  return found == kLevels.end() ? nullptr : &*found;
}

}  // namespace shaken::scene
