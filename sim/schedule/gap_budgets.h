#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/core/types.h"
#include "sim/bounds/velocity_jump.h"
#include "sim/lanes/lanes.h"
#include "sim/lanes/prefetch.h"

namespace shaken {

/// The direction in which the hulls of two rods were apart; 0: not known.
using Direction = std::array<float, 3>;

/// How much of the gap to each neighbour the hits on a rod may still use up.
///
/// Model:  a bound says that the gap of a pair is still open at tick `until`, by `gap_at_until`. A part of that is the
///         budget of each of the two rods. A hit at `now` that makes the gap close faster by f spends
///         f (until - now) of the budget of the rod that was hit, or returns it if f < 0. While neither budget is
///         overspent, the bound holds, and the pair need not be looked at. With half of the rate at which the gap
///         closes, a budget tells the rod's share of the gap at any tick before `until`: a straight line. A hit that
///         displaced the rod must leave it at `now`, too.
/// Layout: a rod has a row of lanes, one for each of its pairs, so that a hit spends all of its budgets at once.
class GapBudgets {
 public:
  /// A bound lasts at most this much longer than `until` [ticks].
  static constexpr int kMostBeyond = 64;

  GapBudgets(std::size_t n_rods, double dt);

  /// Gives the rod a lane for a pair, with an empty budget, and returns the lane's number.
  int add(int rod, int pair);
  /// Removes a lane of the rod. Its last lane moves there: returns the pair of that lane, or -1 if it was the last.
  int remove(int rod, int lane);

  /// Sets the direction from the rod to the other one; 0: not known.
  void set_direction(int rod, int lane, const Direction& direction, float sign);
  /// Sets the budget that hits may spend until then [mm], and the rod's share of the rate at which the gap closes
  /// without them [mm/s].
  void set(int rod, int lane, float budget, float rate, Tick until);
  /// Sets a budget that any hit overspends.
  void set_empty(int rod, int lane);
  /// Sets a budget that no hit overspends.
  void set_unlimited(int rod, int lane);
  /// What remains of the budget; < 0: it is overspent [mm].
  float remaining(int rod, int lane) const { return block(rod, lane).remaining[lane % kInBlock]; }
  /// The rod's share of the rate at which the gap closes, with the hits since `set` [mm/s].
  float rate(int rod, int lane) const { return block(rod, lane).rate[lane % kInBlock]; }

  /// Spends what a hit on the rod costs, of all its budgets. Calls each(pair) for those that are overspent.
  template <class Each>
  void spend(int rod, const VelocityJump& jump, Tick now, const Each& each) {
    for (int first = 0; first < n_lanes_[rod]; first += kInBlock) {
      Block& in = block(rod, first);
      const std::uint32_t all = (1U << std::min(kInBlock, n_lanes_[rod] - first)) - 1;
      std::uint32_t lanes = spend_from(in, jump, now) & all;
      for (; lanes != 0; lanes &= lanes - 1) each(in.pair[std::countr_zero(lanes)]);
    }
  }

  /// Asks the memory for what `spend` needs of the rod.
  void prefetch(int rod) const {
    shaken::prefetch(block(rod, 0));
    if (n_lanes_[rod] > kInBlock) shaken::prefetch(block(rod, kInBlock));
  }
  /// Asks the memory for what `remaining`, `rate` and `set` need: at most two lines.
  void prefetch(int rod, int lane) const {
    prefetch_line(block(rod, lane).remaining);
    prefetch_line(block(rod, lane).until);
  }
  std::size_t bytes() const;

 private:
  /// Most rods have about this many neighbours; wider blocks would mostly be empty lanes.
  static constexpr int kInBlock = 8;
  struct alignas(32) Block {
    float remaining[kInBlock];
    float rate[kInBlock];
    std::int32_t until[kInBlock];  ///< the tick's last 32 bits
    std::int32_t pair[kInBlock];
    float direction[3][kInBlock];
  };
  struct SpendKernel;
  /// Returns a bit for each lane that is overspent.
  std::uint32_t spend_from(Block& block, const VelocityJump& jump, Tick now) const;

  template <class Budgets>
  static auto& block_of(Budgets& of, int rod, int lane) {
    if (lane < kInBlock) return of.first_[rod];
    return of.further_[static_cast<std::size_t>(rod) * of.n_further_ + static_cast<std::size_t>(lane / kInBlock - 1)];
  }
  Block& block(int rod, int lane) { return block_of(*this, rod, lane); }
  const Block& block(int rod, int lane) const { return block_of(*this, rod, lane); }
  static Block empty_block();
  void widen();

  std::vector<Block> first_;    ///< (n_rods)
  std::vector<Block> further_;  ///< (n_rods x n_further) of rods with many pairs; apart, so that the first lie close
  std::size_t n_further_ = 0;
  std::vector<std::int32_t> n_lanes_;
  float dt_;
};

}  // namespace shaken
