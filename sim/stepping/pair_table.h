// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/contact/safe_time.h"
#include "sim/lanes/prefetch.h"
#include "sim/stepping/gap_allowances.h"
#include "sim/stepping/timing_wheel.h"

namespace shaken {

using PairRods = std::array<int, 2>;

/// What the scheduled stepper knows of the pairs in the neighbour list, under the numbers that the list gives them.
///
/// A pair comes up somewhat before its bound ends, so that hits on its rods have something to take (GapAllowances). If
/// much of the bound's time is left by then, the pair waits on; if hits have used up what they may take before, it
/// comes up sooner. Neither needs more than a few operations.
class PairTable {
 public:
  /// For rods that move in ticks of `dt` [s].
  PairTable(std::size_t n_rods, double dt, int n_owners = 1);

  /// Numbers are below `n_pairs` from now on.
  void make_room(std::size_t n_pairs);
  void add(int p, const PairRods& rods, std::uint8_t owner);
  void remove(int p);
  bool is_used(int p) const { return pairs_[p].rods != kUnused; }

  const PairRods& rods(int p) const { return pairs_[p].rods; }
  /// In which the hulls were apart at the last bound.
  const Direction& direction(int p) const { return pairs_[p].direction; }
  int owner(int p) const { return pairs_[p].owner; }  ///< the pair's thread

  /// Gives the pair a bound: nothing can happen for so many ticks after `now`, at whose end the gap has the
  /// line's width, along the direction from the first rod to the second one. Without a line it does not survive a hit.
  void hold(int p, Tick now, int ticks, const Direction& direction, const GapLine& line);
  /// Has the pair come up at the next tick, whatever hits its rods until then.
  void search_again(int p, Tick now);
  /// Tells the pairs of a rod that its motion has changed. Calls each(p) for those that must be settled then.
  template <class Each>
  void take(int rod, const MotionChange& change, Tick now, const Each& each) {
    allowances_.take(rod, change, now, each);
  }
  /// Has the pair's bound hold on although hits may have used up what they were allowed. False if it had better be made
  /// anew.
  bool settle(int p, Tick now);
  /// Has a pair that has come up at `now` wait on, if enough of its bound's time is left.
  bool waits_on(int p, Tick now);

  /// Ticks after `now` for which the pair's bound holds, if it has a line; hits may make them fewer.
  int ticks_left(int p, Tick now) const;

  /// Beads overlapped at the last search for contacts.
  bool is_touching(int p) const { return (pairs_[p].marks & kTouching) != 0; }
  void turn_touching(int p);
  int n_touching(int rod) const { return n_touching_[rod]; }  ///< pairs of the rod

  Tick detected_at(int p) const { return detected_at_[p]; }  ///< of the last search for contacts
  void set_detected(int p, Tick now) {
    mark(p, kAgain, detected_at_[p] == now - 1);
    detected_at_[p] = now;
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

  /// Has the pair come up at tick `due`, and at no other.
  void set_due(int p, Tick due) { wheel_.set(p, due, pairs_[p].owner); }
  TimingWheel& wheel() { return wheel_; }

  /// Asks for what `take` needs of a rod.
  void prefetch_rod(int rod) const { allowances_.prefetch(rod); }
  /// Asks for the pair's record,
  void prefetch(int p) const {
    shaken::prefetch(pairs_[p]);
    wheel_.prefetch(p);
  }
  /// and, by that, for what else is known of its bound.
  void prefetch_bound(int p) const {
    for (std::size_t r = 0; r < 2; ++r) allowances_.prefetch(pairs_[p].rods[r], pairs_[p].lanes[r]);
  }
  std::size_t bytes() const;

 private:
  enum Mark : std::uint8_t { kTouching = 1, kListed = 2, kHasLine = 4, kAgain = 8 };
  static constexpr PairRods kUnused{-1, -1};  ///< of a number that the neighbour list does not use

  struct Pair {
    PairRods rods = kUnused;
    Direction direction{};
    float closing = 0;                     ///< of the bound's line, without the hits since then [mm/s]
    std::int32_t end = 0;                  ///< tick at which the bound ends, its last 32 bits
    std::int32_t until = 0;                ///< the pair comes up at the tick after it; allowances are for it
    std::array<std::uint16_t, 2> lanes{};  ///< of its rods, in allowances_
    std::uint8_t marks = 0;
    std::uint8_t owner = 0;
  };

  void mark(int p, Mark what, bool set) {
    pairs_[p].marks = static_cast<std::uint8_t>(set ? pairs_[p].marks | what : pairs_[p].marks & ~what);
  }
  struct Remaining;
  Remaining remaining(int p, Tick now) const;
  void allow(int p, Tick now, const Remaining& bound);

  std::vector<Pair> pairs_;
  std::vector<Tick> detected_at_;
  TimingWheel wheel_;
  GapAllowances allowances_;
  std::vector<std::int16_t> n_touching_;  ///< (n_rods)
  float dt_;
};

}  // namespace shaken
