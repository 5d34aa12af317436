#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/keys/problem.h"
#include "scene/load.h"

namespace shaken::scene {

/// The plan of a scene that must be right.
inline RunPlan plan_of(std::string_view text, const std::vector<std::string>& settings = {}) {
  const Loaded<RunPlan> loaded = load_scene(text, "run.json", settings);
  EXPECT_TRUE(loaded) << text << "\n" << to_string(loaded.error());
  return loaded ? *loaded : RunPlan{};
}

/// The problems of a scene that must be wrong, as the user sees them.
inline std::vector<std::string> problems_of(std::string_view text, const std::vector<std::string>& settings = {}) {
  const Loaded<RunPlan> loaded = load_scene(text, "run.json", settings);
  EXPECT_FALSE(loaded) << text;
  std::vector<std::string> lines;
  for (const Problem& problem : loaded.error()) lines.push_back(to_string(problem));
  return lines;
}

/// The only problem of such a scene.
inline std::string problem_of(std::string_view text, const std::vector<std::string>& settings = {}) {
  const std::vector<std::string> lines = problems_of(text, settings);
  if (lines.size() == 1) return lines.front();
  std::string all = std::to_string(lines.size()) + " problems:\n";
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

}  // namespace shaken::scene
