#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "base/core/types.h"

/// Random cases for the comparison of steppers, over everything that a scene may say, and over states that no scene
/// starts from: rods that drift together, or spin and fly as in a hot gas, at any tick.
namespace shaken::test {

/// A scene and what is done with it. As JSON: {"scene": {...}, "ticks": ..., "stop": ..., ...}.
struct SceneCase {
  nlohmann::ordered_json scene;
  Tick ticks = 1000;  ///< for which the steppers are compared
  Tick stop = 500;    ///< at which the scheduled stepper is stopped and resumed
  Tick begin = 0;     ///< at which the world begins
  int threads = 1;    ///< of a third comparison; 1: there is none
  double drift = 0;   ///< speed along (0.6, 0.8) that all rods have besides [mm/s]
  double heat = 0;    ///< standard deviation of a velocity's components that each rod has besides [mm/s]
  double spin = 0;    ///< the same of angular velocities [rad/s]

  nlohmann::ordered_json to_json() const;
  static SceneCase from_json(const nlohmann::ordered_json& json);
};

/// The case number `seed`. Many are not valid: they are drawn again, with another seed.
SceneCase draw_scene_case(std::uint64_t seed);

/// What came of a case.
struct CaseResult {
  bool is_valid = false;   ///< the scene is accepted and its rods can be placed
  std::string difference;  ///< what differed between the steppers; empty: nothing
  bool in_full = false;    ///< at least half of the ticks were compared
  std::int64_t rod_ticks = 0;
  std::string problem;  ///< why it is not valid
};
CaseResult compare_steppers(const SceneCase& one);

/// A case in which steppers differ, made as small and plain as it gets while they still do, with at most `tries`
/// comparisons.
SceneCase shrink(SceneCase one, int tries = 300);

}  // namespace shaken::test
