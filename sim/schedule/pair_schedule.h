#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/bounds/safe_time.h"
#include "sim/lanes/prefetch.h"
#include "sim/schedule/gap_budgets.h"
#include "sim/schedule/timing_wheel.h"

namespace shaken {

using PairRods = std::array<int, 2>;

/// When each pair of the neighbour list is to be searched for contacts, under the numbers that the list gives them.
///
/// A pair comes up somewhat before its bound ends, so that a part of its gap becomes a budget for the hits on its
/// rods (GapBudgets). If the bound holds by then, the pair needs a new one, but no search; if hits overspend the budget
/// before, the bound is shortened, which needs few operations.
class PairSchedule {
 public:
  /// For rods that move in ticks of `dt` [s].
  PairSchedule(std::size_t n_rods, double dt, int n_owners = 1);

  /// From now on numbers are below `n_pairs`.
  void make_room(std::size_t n_pairs);
  void add(int p, const PairRods& rods, std::uint8_t owner);
  void remove(int p);
  bool is_used(int p) const { return pairs_[p].rods != kUnused; }

  const PairRods& rods(int p) const { return pairs_[p].rods; }
  /// The direction in which the hulls were apart at the last bound.
  const Direction& direction(int p) const { return pairs_[p].direction; }
  int owner(int p) const { return pairs_[p].owner; }  ///< the pair's thread

  /// Sets the pair's bound: nothing can happen for `ticks` after `now`, and until then the gap is at least `gap`, along
  /// the direction from the first rod to the second one. Without a gap (residual < 0) the bound does not survive a hit.
  void set_bound(int p, Tick now, int ticks, const Direction& direction, const GapBound& gap);
  /// Brings the pair up at the next tick, whatever hits its rods until then.
  void poll(int p, Tick now);
  /// Spends what a hit on the rod costs, of the budgets of all its pairs. Calls each(p) for those that are overspent.
  template <class Each>
  void spend(int rod, const VelocityJump& jump, Tick now, const Each& each) {
    budgets_.spend(rod, jump, now, each);
  }
  /// Makes the bound of an overspent pair as much shorter as the hits since require. False where a new bound is better.
  bool shorten_bound(int p, Tick now);
  /// Whether the bound of a pair that has come up at `now` still holds: the rods cannot touch in this tick.
  bool is_apart(int p, Tick now) const;

  /// Beads overlapped at the last search for contacts.
  bool is_touching(int p) const { return (pairs_[p].marks & kTouching) != 0; }
  void toggle_touching(int p);
  int n_touching(int rod) const { return n_touching_[rod]; }  ///< pairs of the rod

  Tick searched_at(int p) const { return searched_at_[p]; }  ///< of the last search for contacts
  void set_searched(int p, Tick now) {
    mark(p, kAgain, searched_at_[p] == now - 1);
    searched_at_[p] = now;
  }
  /// Beads overlapped at the last search, which came a tick after another one.
  bool keeps_touching(int p) const { return (pairs_[p].marks & kAgain) != 0 && is_touching(p); }

  /// Puts pairs on a list once: appends p unless it is there already.
  void list(int p, std::vector<int>& pairs) {
    if (pairs_[p].marks & kListed) return;
    pairs_[p].marks |= kListed;
    pairs.push_back(p);
  }
  bool is_listed(int p) const { return (pairs_[p].marks & kListed) != 0; }
  void unlist(int p) { mark(p, kListed, false); }

  /// Brings the pair up at tick `due`, and at no other.
  void set_due(int p, Tick due) { wheel_.set(p, due, pairs_[p].owner); }
  TimingWheel& wheel() { return wheel_; }

  /// Asks the memory for what `spend` needs of a rod.
  void prefetch_rod(int rod) const { budgets_.prefetch(rod); }
  /// Asks the memory for the pair's record,
  void prefetch(int p) const {
    shaken::prefetch(pairs_[p]);
    wheel_.prefetch(p);
  }
  /// and, by that, for what else is known of its bound.
  void prefetch_bound(int p) const {
    for (std::size_t r = 0; r < 2; ++r) budgets_.prefetch(pairs_[p].rods[r], pairs_[p].lanes[r]);
  }
  std::size_t bytes() const;

 private:
  enum Mark : std::uint8_t { kTouching = 1, kListed = 2, kSurvivesHits = 4, kAgain = 8 };
  static constexpr PairRods kUnused{-1, -1};  ///< of a number that the neighbour list does not use

  struct Pair {
    PairRods rods = kUnused;
    Direction direction{};
    std::int32_t end = 0;                  ///< tick at which the bound ends, its last 32 bits
    std::int32_t until = 0;                ///< the pair comes up at the tick after it; budgets last until then
    std::array<std::uint16_t, 2> lanes{};  ///< of its rods, in budgets_
    std::uint8_t marks = 0;
    std::uint8_t owner = 0;
  };

  void mark(int p, Mark what, bool set) {
    pairs_[p].marks = static_cast<std::uint8_t>(set ? pairs_[p].marks | what : pairs_[p].marks & ~what);
  }
  struct Remaining;
  Remaining remaining(int p, Tick now) const;
  void set_budgets(int p, Tick now, const Remaining& bound);

  std::vector<Pair> pairs_;
  std::vector<Tick> searched_at_;
  TimingWheel wheel_;
  GapBudgets budgets_;
  std::vector<std::int16_t> n_touching_;  ///< (n_rods)
  float dt_;
};

}  // namespace shaken
