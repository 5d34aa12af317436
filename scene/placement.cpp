// SPDX-License-Identifier: MIT
#include "scene/placement.h"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>
#include <utility>

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

/// The nearest larger side, in halves of a millimetre (tenths below 5 mm) and at most three tenths larger, whose box
/// holds rods of the same area fraction in rows, however that is rounded to whole rods; none if there is none, or for
/// another start. Rows are not commensurate with every side, so it need not be the largest that counts.
std::optional<double> nearest_side(const System& system) {
  if (system.start != Start::kAligned || system.walls) return std::nullopt;
  constexpr int kMostTries = 60;
  const double per_mm = system.box_side < 5 ? 10 : 2;
  System larger = system;
  for (int k = 1; k <= kMostTries; ++k) {
    larger.box_side = (std::floor(system.box_side * per_mm) + k) / per_mm;
    if (larger.box_side > 1.3 * system.box_side) break;
    const double more = larger.box_side * larger.box_side / (system.box_side * system.box_side);
    const auto scaled = [more](int count) { return static_cast<int>(std::lround((count + 0.5) * more)); };
    larger.n_rods = scaled(system.n_rods);
    for (std::size_t s = 0; s < system.added.size(); ++s) {
      if (system.added[s]) larger.added[s]->count = scaled(system.added[s]->count);
    }
    if (make_world(larger)) return larger.box_side;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Problem> placement_problem(const RunPlan& plan, const std::string& file, const std::string& label) {
  if (plan.start) return std::nullopt;  // nothing is placed
  const Result<World> world = make_world(plan.system);
  if (world) return std::nullopt;
  std::string message = label.empty() ? world.error().message : label + ": " + world.error().message;
  if (const auto side = nearest_side(plan.system))
    message += fmt::format("; a box.side of {:.10g} mm holds this area fraction", *side);
  return Problem{file, 0, 0, "/rods", std::move(message)};
}

Loaded<Sweep> load_runs(std::string_view text, const std::string& file, std::span<const std::string> settings,
                        std::optional<int> replicas) {
  Loaded<Sweep> sweep = load_sweep(text, file, settings, replicas);
  if (!sweep) return sweep;
  std::unordered_map<std::string, bool> can_be_placed;
  std::size_t n_fine = 0;
  std::vector<Problem> problems;
  const double allowed = memory_allowed();
  for (const SweepPoint& point : sweep->points) {
    if (auto problem = memory_problem(point.plan, allowed, file, point.label)) {
      problems.push_back(*std::move(problem));
      continue;
    }
    const auto [known, is_new] = can_be_placed.try_emplace(placement_key(point.plan), true);
    if (is_new) {
      if (auto problem = placement_problem(point.plan, file, point.label)) {
        problems.push_back(*std::move(problem));
        known->second = false;
      }
    }
    n_fine += known->second ? 1 : 0;
  }
  if (!problems.empty()) {
    if (n_fine > 0) problems.back().message += fmt::format("; {} of {} points are fine", n_fine, sweep->points.size());
    return tidied(std::move(problems));
  }
  return sweep;
}

}  // namespace shaken::scene
