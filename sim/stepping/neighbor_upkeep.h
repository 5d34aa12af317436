#pragma once

#include <numeric>
#include <span>
#include <vector>

#include "sim/schedule/pair_schedule.h"
#include "sim/stepping/rod_states.h"
#include "sim/stepping/share.h"

namespace shaken {

/// Keeps the neighbour list complete, and the schedule of pairs to the pairs of the list: a rod whose skin budget is
/// used up is placed anew, and its pairs are found anew. Keeps references.
class NeighborUpkeep {
 public:
  NeighborUpkeep(NeighborList& list, PairSchedule& pairs, RodStates& rods, std::vector<Share>& shares)
      : list_(list), pairs_(pairs), rods_(rods), shares_(shares) {}

  /// Builds the list from where the rods are at the first tick, and has all its pairs searched.
  void first_tick(Tick now) {
    const int n_rods = static_cast<int>(rods_.marks.size());
    std::vector<Pose> poses(rods_.marks.size());
    for (int i = 0; i < n_rods; ++i) poses[i] = rods_.flight_pose(i);
    list_.build(poses);
    for (int i = 0; i < n_rods; ++i) measure(i, now);
    gained_.resize(list_.pairs().size());
    std::iota(gained_.begin(), gained_.end(), 0);
    add_gained();
  }

  /// Gives rods `to_place` their new places.
  void place_rods(Tick now) {
    gained_may_touch_ = false;
    for (Share& share : shares_) {
      share.searched.clear();
      for (const int i : share.to_place) {
        if (!(rods_.skin_budgets[i].remaining(now, rods_.rules.dt) >= 0)) gained_may_touch_ = true;
        list_.place(i, rods_.flight_pose(i));
      }
    }
  }

  /// Finds the rods near those of `to_place`. In each share by itself, once all rods have their new places.
  void find_near(Tick now, Share& share) {
    share.near.clear();
    share.near_end.clear();
    for (const int i : share.to_place) {
      measure(i, now);
      list_.find_near(i, share.near);
      share.near_end.push_back(share.near.size());
    }
  }

  /// Gives rods `to_place` their new pairs. Returns the pairs gained if they may touch in this tick already: where a
  /// rod has moved further than its budget.
  std::span<const int> replace_pairs() {
    if (std::ranges::all_of(shares_, [](const Share& share) { return share.to_place.empty(); })) return {};
    gained_.clear();
    lost_.clear();
    for (Share& share : shares_) {
      std::size_t begin = 0;
      for (std::size_t k = 0; k < share.to_place.size(); ++k) {
        const auto near = std::span(share.near).subspan(begin, share.near_end[k] - begin);
        list_.replace_pairs(share.to_place[k], near, gained_, lost_);
        begin = share.near_end[k];
      }
      share.to_place.clear();
    }
    pairs_.make_room(list_.pairs().size());  // a pair may be gained and lost by the same tick
    for (const int p : lost_) pairs_.remove(p);
    add_gained();
    return gained_may_touch_ ? gained_ : std::span<const int>();
  }

  std::size_t bytes() const { return heap_bytes(gained_, lost_); }

 private:
  void measure(int i, Tick now) { rods_.skin_budgets[i].measure(list_, i, rods_.at_tick[i].pose, now); }

  void add_gained() {
    pairs_.make_room(list_.pairs().size());
    for (const int p : gained_) {
      const auto& [i, j] = list_.pairs()[p];
      if (i < 0 || pairs_.is_used(p)) continue;  // lost again, or met twice
      pairs_.add(p, {i, j}, rods_.owners[i]);
      shares_[rods_.owners[i]].searched.push_back(p);
    }
  }

  NeighborList& list_;
  PairSchedule& pairs_;
  RodStates& rods_;
  std::vector<Share>& shares_;
  std::vector<int> gained_, lost_;
  bool gained_may_touch_ = false;
};

}  // namespace shaken
