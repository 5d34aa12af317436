#pragma once

#include <vector>

#include "base/core/heap_bytes.h"
#include "sim/lanes/prefetch.h"
#include "sim/schedule/loops.h"
#include "sim/schedule/skin_budget.h"
#include "sim/tick/tick.h"

namespace shaken {

/// The rods at a tick, and what its phases note of each. All lists are (n_rods).
struct RodStates {
  struct Marks {
    Tick posed_at = -1;              ///< tick of the rod in `at_tick`
    Tick scheduled_at = -1;          ///< tick at which it was last to be scheduled
    Tick hit_at = -1;                ///< tick at which it was last hit
    Tick hit_again_at = -1;          ///< last tick at which a surface hit it when it had been hit in the tick before
    Tick bounded_at = -1;            ///< tick of its flight bound
    Tick touching_searched_at = -1;  ///< tick in which all of its pairs that touch are searched for contacts
  };

  RodStates(const TickRules& tick_rules, std::size_t n_shares)
      : rules(tick_rules),
        at_tick(rules.shape_of_rod.size()),
        flight_poses(rules.system.has_impacts_at_instant() ? at_tick.size() : 0),
        skin_budgets(at_tick.size()),
        marks(at_tick.size()),
        owners(at_tick.size()) {
    // rods are numbered along the rows that they start in, so these are bands of the plane
    const std::size_t n = at_tick.size();
    for (std::size_t i = 0; i < n; ++i) owners[i] = static_cast<std::uint8_t>(i * n_shares / n);
  }

  /// Lets the rod fly freely to the tick.
  [[gnu::always_inline]] void pose(int i, const World& world, Tick now) {
    at_tick[i] = rod_at_tick(world.rods[i], now, rules);
    if (!flight_poses.empty()) flight_poses[i] = at_tick[i].pose;
  }
  void pose_if_needed(int i, const World& world, Tick now) {
    if (claim_pose(i, now)) pose(i, world, now);
  }
  /// Whether the rod has not been posed in this tick yet; whoever asks must do it then.
  bool claim_pose(int i, Tick now) {
    if (marks[i].posed_at == now) return false;
    marks[i].posed_at = now;
    return true;
  }
  void pose_all(const std::vector<int>& rods, const World& world, Tick now) {
    const auto ask = [&](int i) {
      prefetch(world.rods[i]);
      prefetch(at_tick[i]);
    };
    for_each_prefetched(rods, ask, [&](int i) { pose(i, world, now); });
  }
  /// Where free flight brought the rod; impacts at their instant may have displaced it since.
  const Pose& flight_pose(int i) const { return flight_poses.empty() ? at_tick[i].pose : flight_poses[i]; }
  /// Groups of rods of one shape.
  auto by_shape() const {
    return Groups(rules.species.size() > 1, [this](int i) { return static_cast<int>(rules.shape_of_rod[i]); });
  }
  std::size_t bytes() const { return heap_bytes(at_tick, flight_poses, skin_budgets, marks, owners); }

  const TickRules& rules;
  std::vector<RodAtTick> at_tick;
  std::vector<Pose> flight_poses;  ///< or empty, if nothing displaces rods
  std::vector<SkinBudget> skin_budgets;
  std::vector<Marks> marks;
  std::vector<std::uint8_t> owners;  ///< the share of each rod
};

}  // namespace shaken
