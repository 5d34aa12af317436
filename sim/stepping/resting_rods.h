// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/bounds/velocity_jump.h"
#include "sim/motion/flight_lanes.h"
#include "sim/schedule/skin_budget.h"
#include "sim/tick/plate_impacts.h"
#include "sim/tick/tick.h"

namespace shaken {

/// Rods that rest on a plate, which hits them tick after tick. As long as they do, their flights stay here, eight of
/// one species a block, and all that a tick does to them is done to a whole block: the hit, the new flight, the jump of
/// the velocity. Their flights in the world are stale meanwhile. A rod to which anything else happens leaves.
///
/// A rod has a slot: its block times the number of lanes, plus its lane, among the blocks of its species.
class RestingRods {
 public:
  /// Keeps a reference to `rules`. `slow` as PairSearch::slow() [mm/s].
  RestingRods(const TickRules& rules, float slow);

  /// Takes a rod in whose flight began at this tick; returns its slot.
  int enter(int i, const Flight& flight, const SkinBudget& skin);
  /// The rod's flight, and what is left of its skin budget, are the caller's again.
  void leave(int i, int slot, Flight& flight, SkinBudget& skin);
  /// The flight, which began at the tick of the last begin_flights(), with the image of the box that it is in.
  Flight flight(int i, int slot) const;
  /// The rod at the tick of the last meet_plates().
  void get(int i, int slot, RodAtTick& rod) const { block_of(i, slot).hits.get(slot % kLanes8, rod); }
  int size() const { return size_; }

  /// Phase 1: has plates hit all rods, and counts the hits. Calls stays(i) for each rod for which that is all, and
  /// leaves(i, slot) for the others, whose hits are neither counted nor stored: they are to leave().
  template <class Stays, class Leaves>
  void meet_plates(const PlateState& plates, Tick now, Counters& counters, const Stays& stays, const Leaves& leaves);

  /// Phase 4: new flights for all rods. Calls each(i, jump) for each rod.
  template <class Each>
  void begin_flights(Tick now, const Each& each);

  /// Closes gaps among the blocks; calls moved(i, slot) for rods with another slot.
  template <class Moved>
  void pack(const Moved& moved);

  /// Calls each(i, slot) for all rods.
  template <class Each>
  void for_each(const Each& each) const;

  std::size_t bytes() const;

 private:
  static constexpr int kLanes8 = lanes::kDoubleLanes;
  static constexpr int kNone = -1;
  /// Velocity jumps of a block's rods.
  struct JumpLanes {
    alignas(32) float velocity[3][kLanes8];
    alignas(32) float tip[3][kLanes8];
    alignas(32) float size[3][kLanes8];  ///< rounding, along any direction, curvature
  };
  struct Block {
    std::array<int, kLanes8> rods;
    std::array<std::array<std::int32_t, 2>, kLanes8> image{};
    FlightLanes flights{};
    alignas(64) double skin_left[kLanes8]{};   ///< when the flights began [mm]
    alignas(64) double skin_speed[kLanes8]{};  ///< [mm/s]
    PlateHits hits{};
    JumpLanes jumps{};
  };
  struct StoreKernel;

  std::vector<Block>& blocks_of(int i) { return blocks_[rules_.species_of_rod[static_cast<std::size_t>(i)]]; }
  const Block& block_of(int i, int slot) const {
    return blocks_[rules_.species_of_rod[static_cast<std::size_t>(i)]][static_cast<std::size_t>(slot / kLanes8)];
  }
  bool stays(const Block& block, int lane) const;
  void begin_flights_of(Block& block, const SpeciesMechanics& species) const;
  VelocityJump jump(const Block& block, int lane) const;

  const TickRules& rules_;
  double slow_;
  Tick since_ = -1;                         ///< of all flights
  std::vector<std::vector<Block>> blocks_;  ///< (n_species x n_blocks)
  std::vector<std::vector<int>> free_;      ///< (n_species x n) slots without a rod
  int size_ = 0;
};

template <class Stays, class Leaves>
void RestingRods::meet_plates(const PlateState& plates, Tick now, Counters& counters, const Stays& stays_in,
                              const Leaves& leaves) {
  alignas(64) double since[kLanes8];
  for (double& one : since) one = static_cast<double>(now - since_) * rules_.dt;
  for (std::size_t s = 0; s < blocks_.size(); ++s) {
    for (std::size_t b = 0; b < blocks_[s].size(); ++b) {
      Block& block = blocks_[s][b];
      hit_plates(rules_.species[s], block.flights, since, kLanes8, plates, rules_, block.hits);
      for (int lane = 0; lane < kLanes8; ++lane) {
        const int i = block.rods[static_cast<std::size_t>(lane)];
        if (i == kNone) continue;
        if (stays(block, lane)) {
          block.hits.count(lane, plates, counters);
          stays_in(i);
        } else {
          leaves(i, static_cast<int>(b) * kLanes8 + lane);
        }
      }
    }
  }
}

template <class Each>
void RestingRods::begin_flights(Tick now, const Each& each) {
  since_ = now;
  for (std::size_t s = 0; s < blocks_.size(); ++s) {
    for (Block& block : blocks_[s]) {
      begin_flights_of(block, rules_.species[s]);
      for (int lane = 0; lane < kLanes8; ++lane) {
        const int i = block.rods[static_cast<std::size_t>(lane)];
        if (i != kNone) each(i, jump(block, lane));
      }
    }
  }
}

template <class Moved>
void RestingRods::pack(const Moved& moved) {
  for (std::size_t s = 0; s < blocks_.size(); ++s) {
    if (free_[s].size() < 2 * static_cast<std::size_t>(kLanes8)) continue;
    const int first = (static_cast<int>(blocks_[s].size()) - 1) * kLanes8;  // slot of the last block
    std::erase_if(free_[s], [&](int slot) { return slot >= first; });
    const Block& last = blocks_[s].back();
    for (int lane = 0; lane < kLanes8; ++lane) {
      const int i = last.rods[static_cast<std::size_t>(lane)];
      if (i == kNone) continue;
      const int slot = free_[s].back();
      free_[s].pop_back();
      Block& block = blocks_[s][static_cast<std::size_t>(slot / kLanes8)];
      const auto to = static_cast<std::size_t>(slot % kLanes8);
      Flight flight;
      last.flights.get(lane, flight);
      block.flights.set(slot % kLanes8, flight);
      block.rods[to] = i;
      block.image[to] = last.image[static_cast<std::size_t>(lane)];
      block.skin_left[to] = last.skin_left[lane];
      block.skin_speed[to] = last.skin_speed[lane];
      moved(i, slot);
    }
    blocks_[s].pop_back();
  }
}

template <class Each>
void RestingRods::for_each(const Each& each) const {
  for (const std::vector<Block>& blocks : blocks_) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (int lane = 0; lane < kLanes8; ++lane) {
        const int i = blocks[b].rods[static_cast<std::size_t>(lane)];
        if (i != kNone) each(i, static_cast<int>(b) * kLanes8 + lane);
      }
    }
  }
}

}  // namespace shaken
