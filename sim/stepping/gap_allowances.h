// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/core/lanes.h"
#include "sim/core/types.h"
#include "sim/stepping/motion_change.h"

namespace shaken {

using lanes::kLanes;

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
  float left(int rod, int lane) const { return block(rod, lane).left[lane % kLanes]; }
  /// By how much faster hits have made the gap close since `allow` [mm/s].
  float faster(int rod, int lane) const { return block(rod, lane).faster[lane % kLanes]; }

  /// Takes what a change of the rod's motion takes from all its allowances. Calls each(pair) for those that are used
  /// up, and for every pair of a rod that was displaced: its gap may be less now than when the bound ends.
  template <class Each>
  void take(int rod, const MotionChange& change, Tick now, const Each& each) {
    const bool is_displaced = change.earlier() > 0.0F;
    for (int first = 0; first < n_lanes_[rod]; first += kLanes) {
      Block& in = block(rod, first);
      const int n = std::min(kLanes, n_lanes_[rod] - first);
      std::uint32_t lanes = take_from(in, n, change, now);
      if (is_displaced) lanes = (1U << n) - 1;
      for (; lanes != 0; lanes &= lanes - 1) each(in.pair[std::countr_zero(lanes)]);
    }
  }

  void prefetch(int rod) const;
  std::size_t bytes() const;

 private:
  struct alignas(64) Block {
    float direction[3][kLanes];
    float left[kLanes];
    float faster[kLanes];
    std::int32_t until[kLanes];  ///< the tick's last 32 bits
    std::int32_t pair[kLanes];
  };
  struct TakeKernel;
  /// The first n lanes. Returns a bit for each that is used up.
  std::uint32_t take_from(Block& block, int n, const MotionChange& change, Tick now) const;

  Block& block(int rod, int lane) {
    return blocks_[static_cast<std::size_t>(rod) * n_blocks_ + static_cast<std::size_t>(lane / kLanes)];
  }
  const Block& block(int rod, int lane) const {
    return blocks_[static_cast<std::size_t>(rod) * n_blocks_ + static_cast<std::size_t>(lane / kLanes)];
  }
  void widen();

  std::vector<Block> blocks_;  ///< (n_rods x n_blocks)
  std::size_t n_blocks_ = 1;   ///< of each rod
  std::vector<std::int32_t> n_lanes_;
  float dt_;
};

}  // namespace shaken
