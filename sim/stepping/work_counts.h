#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace shaken {

/// What a stepper does to know where to look, and finds there.
enum class WorkKind {
  kRodsVisited,      ///< for surfaces
  kRodsHit,          ///< of these, hit by a surface
  kRodsPolled,       ///< of these, to be visited at the next tick without a bound
  kRodsBounded,      ///< bounds on the time to the next surface
  kRodsPlaced,       ///< entered into the neighbour list anew
  kPairsSearched,    ///< for contacts
  kPairsTouching,    ///< of these, with overlapping beads
  kVelocityJumps,    ///< hits on rods, spent from the budgets of their pairs
  kBoundsShortened,  ///< bounds that were kept, shorter, although hits had used up what they were allowed
  kPairsApart,       ///< came up while their bounds held, and were not searched
  kPairsBounded,     ///< new bounds on the time to contact
  kBoundsWhenDue,    ///< of these, of pairs that came up; the others because a rod was hit
  kBoundsByBeads,    ///< of these, for which beads were looked at
  kBoundsOfNoTick,   ///< of these, too short to save a visit at the next tick
};
inline constexpr std::size_t kWorkKinds = 14;
inline constexpr std::array<const char*, kWorkKinds> kWorkNames{
    "rods_visited",   "rods_hit",        "rods_polled",     "rods_bounded",     "rods_placed",
    "pairs_searched", "pairs_touching",  "velocity_jumps",  "bounds_shortened", "pairs_apart",
    "pairs_bounded",  "bounds_when_due", "bounds_by_beads", "bounds_of_no_tick"};

/// How often a stepper has done each since it was made.
class WorkCounts {
 public:
  void count(WorkKind work, std::int64_t n = 1) { counts_[static_cast<std::size_t>(work)] += n; }
  std::int64_t of(WorkKind work) const { return counts_[static_cast<std::size_t>(work)]; }
  void add(const WorkCounts& other) {
    for (std::size_t k = 0; k < kWorkKinds; ++k) counts_[k] += other.counts_[k];
  }

 private:
  std::array<std::int64_t, kWorkKinds> counts_{};
};

}  // namespace shaken
