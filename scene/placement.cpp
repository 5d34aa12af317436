// SPDX-License-Identifier: MIT
#include "scene/placement.h"

#include <unordered_set>

#include "scene/canonical.h"
#include "scene/load.h"
#include "scene/memory.h"
#include "sim/initial.h"

namespace shaken::scene {

namespace {

/// The same for all plans whose rods are placed alike, so that a sweep of other keys places them once.
std::string placement_key(const RunPlan& plan) {
  const System& system = plan.system;
  RunPlan alike;
  alike.system.rod = system.rod;
  alike.system.n_rods = system.n_rods;
  alike.system.added = system.added;
  alike.system.box_side = system.box_side;
  alike.system.gap = system.gap;
  alike.system.walls = system.walls;
  alike.system.start = system.start;
  alike.start = plan.start;
  // rows have room for any two rods side by side, whichever kinds the seed puts there
  if (system.start == Start::kRandom) alike.system.seed = system.seed;
  return run_id(alike);
}

}  // namespace

std::optional<Problem> placement_problem(const RunPlan& plan, const std::string& file, const std::string& label) {
  if (plan.start) return std::nullopt;  // nothing is placed
  const Result<World> world = make_world(plan.system);
  if (world) return std::nullopt;
  return Problem{file, 0, 0, "/rods", label.empty() ? world.error().message : label + ": " + world.error().message};
}

Loaded<Sweep> load_runs(std::string_view text, const std::string& file, std::span<const std::string> settings,
                        std::optional<int> replicas) {
  Loaded<Sweep> sweep = load_sweep(text, file, settings, replicas);
  if (!sweep) return sweep;
  std::unordered_set<std::string> placed;
  std::vector<Problem> problems;
  const double allowed = memory_allowed();
  for (const SweepPoint& point : sweep->points) {
    if (auto problem = memory_problem(point.plan, allowed, file, point.label)) {
      problems.push_back(*std::move(problem));
      continue;
    }
    if (!placed.insert(placement_key(point.plan)).second) continue;
    if (auto problem = placement_problem(point.plan, file, point.label)) problems.push_back(*std::move(problem));
  }
  if (!problems.empty()) return tidied(std::move(problems));
  return sweep;
}

}  // namespace shaken::scene
