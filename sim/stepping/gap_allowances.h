// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/core/types.h"
#include "sim/lanes/lanes.h"
#include "sim/lanes/prefetch.h"
#include "sim/stepping/motion_change.h"

namespace shaken {

/// In which direction the hulls of two rods were apart; 0: not known.
using Direction = std::array<float, 3>;

/// What hits on a rod may take of the gaps to its neighbours before the pairs have to be told.
///
/// Model:  a bound promises that the gap of a pair is still open at tick `until`, by some reserve. Each of the two rods
///         is allowed a part of that. A hit at `now` that makes the gap close faster by f takes f (until - now) of the
///         allowance of the rod that was hit, or gives it back if f < 0. As long as neither allowance is used up, the
///         bound holds, and nothing else has to be known of the pair.
/// Layout: a rod has a row of lanes, one for each of its pairs, so that a hit is told to all of them at once.
class GapAllowances {
 public:
  /// A bound may last so much longer than `until` at most [ticks].
  static constexpr int kMostBeyond = 64;

  GapAllowances(std::size_t n_rods, double dt);

  /// Gives the rod a lane for a pair, with nothing allowed, and returns its number.
  int add(int rod, int pair);
  /// Takes the rod's lane out. Its last lane takes that place: returns the pair that it is of, or -1 if there is none.
  int remove(int rod, int lane);

  /// From the rod to the other one; 0: not known.
  void set_direction(int rod, int lane, const Direction& direction, float sign);
  /// Hits may take so much by then [mm].
  void allow(int rod, int lane, float allowance, Tick until);
  /// Any hit uses that up.
  void forbid(int rod, int lane);
  /// None does.
  void allow_all(int rod, int lane);
  /// What is left of the allowance; < 0: it is used up [mm].
  float left(int rod, int lane) const { return block(rod, lane).left[lane % kInBlock]; }
  /// By how much faster hits have made the gap close since `allow` [mm/s].
  float faster(int rod, int lane) const { return block(rod, lane).faster[lane % kInBlock]; }

  /// Takes what a change of the rod's motion takes from all its allowances. Calls each(pair) for those that are used
  /// up, and for every pair of a rod that was displaced: its gap may be less now than when the bound ends.
  template <class Each>
  void take(int rod, const MotionChange& change, Tick now, const Each& each) {
    const bool is_displaced = change.earlier() > 0.0F;
    for (int first = 0; first < n_lanes_[rod]; first += kInBlock) {
      Block& in = block(rod, first);
      const std::uint32_t all = (1U << std::min(kInBlock, n_lanes_[rod] - first)) - 1;
      const std::uint32_t used_up = take_from(in, change, now);
      std::uint32_t lanes = is_displaced ? all : used_up & all;
      for (; lanes != 0; lanes &= lanes - 1) each(in.pair[std::countr_zero(lanes)]);
    }
  }

  /// Asks for what `take` needs of the rod.
  void prefetch(int rod) const {
    shaken::prefetch(block(rod, 0));
    if (n_lanes_[rod] > kInBlock) shaken::prefetch(block(rod, kInBlock));
  }
  /// Asks for what `left`, `faster` and `allow` need.
  void prefetch(int rod, int lane) const {
    shaken::prefetch(block(rod, lane).left);
    shaken::prefetch(block(rod, lane).until);
  }
  std::size_t bytes() const;

 private:
  /// Most rods have about so many neighbours; wider blocks would be empty lanes for the most.
  static constexpr int kInBlock = 8;
  struct alignas(32) Block {
    float left[kInBlock];
    float faster[kInBlock];
    std::int32_t until[kInBlock];  ///< the tick's last 32 bits
    std::int32_t pair[kInBlock];
    float direction[3][kInBlock];
  };
  struct TakeKernel;
  /// Returns a bit for each lane that is used up.
  std::uint32_t take_from(Block& block, const MotionChange& change, Tick now) const;

  Block& block(int rod, int lane) { return const_cast<Block&>(std::as_const(*this).block(rod, lane)); }
  const Block& block(int rod, int lane) const {
    if (lane < kInBlock) return first_[rod];
    return further_[static_cast<std::size_t>(rod) * n_further_ + static_cast<std::size_t>(lane / kInBlock - 1)];
  }
  static Block empty_block();
  void widen();

  std::vector<Block> first_;    ///< (n_rods)
  std::vector<Block> further_;  ///< (n_rods x n_further) of rods with many pairs; apart, so that the first lie close
  std::size_t n_further_ = 0;
  std::vector<std::int32_t> n_lanes_;
  float dt_;
};

}  // namespace shaken
