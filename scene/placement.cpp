#include "scene/placement.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <unordered_map>
#include <utility>

#include "scene/load.h"
#include "scene/memory_limit.h"
#include "sim/start/initial.h"

namespace shaken::scene {

namespace {

/// The same for all plans whose rods are placed alike, so that a sweep of other keys places them once.
RunPlan placed_alike(const RunPlan& plan) {
  const System& system = plan.system;
  RunPlan alike;
  alike.system.rod = system.rod;
  alike.system.n_rods = system.n_rods;
  alike.system.added = system.added;
  alike.system.box_side = system.box_side;
  alike.system.box_aspect = system.box_aspect;
  alike.system.gap = system.gap;
  alike.system.walls = system.walls;
  alike.system.posts = system.posts;
  alike.system.start = system.start;
  alike.system.start_angle = system.start_angle;
  alike.start = plan.start;
  // rows have room for any two rods side by side, whichever kinds the seed puts there
  if (system.start == Start::kRandom) alike.system.seed = system.seed;
  return alike;
}

/// The points whose rods are placed differently, and whether they can be. Points are told apart by a few numbers first:
/// there may be a hundred thousand.
class Placings {
 public:
  /// What was found of an earlier point whose rods are placed alike; null if this is the first, which is then added.
  bool* find_or_add(const RunPlan& plan) {
    const System& system = plan.system;
    std::size_t hash = 0;
    for (const double part :
         {static_cast<double>(system.n_rods), system.box_side, system.box_aspect, system.gap, system.rod.length,
          static_cast<double>(system.start == Start::kRandom ? system.seed : 0)}) {
      hash = 31 * hash + std::hash<double>()(part);
    }
    const RunPlan alike = placed_alike(plan);
    const auto [begin, end] = known_.equal_range(hash);
    for (auto entry = begin; entry != end; ++entry) {
      if (placed_alike(*entry->second.first) == alike) return &entry->second.second;
    }
    last_ = &known_.emplace(hash, Placing{&plan, true})->second;
    return nullptr;
  }
  /// Marks the one that was added last.
  void cannot_be_placed() { last_->second = false; }

 private:
  using Placing = std::pair<const RunPlan*, bool>;
  std::unordered_multimap<std::size_t, Placing> known_;
  Placing* last_ = nullptr;
};

/// The nearest larger side, in halves of a millimetre (tenths below 5 mm) and at most three tenths larger, whose box
/// holds rods of the same area fraction in rows, however that is rounded to whole rods; none if there is none, or for
/// another start; at an angle nearly every side holds as many. Rows are not commensurate with every side, so it need
/// not be the largest that counts.
std::optional<double> nearest_side(const System& system) {
  if (system.start != Start::kAligned || system.start_angle != 0 || system.walls || system.posts) {
    return std::nullopt;
  }
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
  // That takes as long as it takes, and depends on the seed: the run itself says it. Its limits have been checked.
  if (is_compressed(plan.system.start)) return std::nullopt;
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
  Placings placings;
  std::size_t n_fine = 0;
  std::vector<Problem> problems;
  const double allowed = memory_allowed();
  for (const SweepPoint& point : sweep->points) {
    if (auto problem = memory_problem(point.plan, allowed, file, point.label)) {
      problems.push_back(*std::move(problem));
      continue;
    }
    if (const bool* can_be_placed = placings.find_or_add(point.plan)) {
      n_fine += *can_be_placed ? 1 : 0;
    } else if (auto problem = placement_problem(point.plan, file, point.label)) {
      problems.push_back(*std::move(problem));
      placings.cannot_be_placed();
    } else {
      ++n_fine;
    }
  }
  if (!problems.empty()) {
    if (n_fine > 0) problems.back().message += fmt::format("; {} of {} points are fine", n_fine, sweep->points.size());
    return tidied(std::move(problems));
  }
  return sweep;
}

}  // namespace shaken::scene
