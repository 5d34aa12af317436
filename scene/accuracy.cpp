// SPDX-License-Identifier: MIT
#include "scene/accuracy.h"

#include <algorithm>
#include <array>

namespace shaken::scene {
namespace {

constexpr std::array<AccuracyLevel, 3> kLevels{{
    {"draft", "A first look: is there order, do the parameters make sense.", 16e-6, {}, {}},
    {"paper", "The step of Sharma & Soni (2024): for results to be published.", 4e-6, {}, {}},
    {"fine", "To see what the step does to a result.", 1e-6, {}, {}},
}};

}  // namespace

std::span<const AccuracyLevel> accuracy_levels() { return kLevels; }

const AccuracyLevel* accuracy_level(std::string_view name) {
  const auto found =
      std::find_if(kLevels.begin(), kLevels.end(), [&](const auto& level) { return level.name == name; });
  return found == kLevels.end() ? nullptr : &*found;
}

}  // namespace shaken::scene
