// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/contact/safe_time.h"
#include "sim/core/prefetch.h"
#include "sim/stepping/motion_change.h"
#include "sim/stepping/timing_wheel.h"

namespace shaken {

using PairRods = std::array<int, 2>;

/// What the scheduled stepper knows of the pairs in the neighbour list, under the numbers that the list gives them.
class PairTable {
 public:
  explicit PairTable(std::size_t n_rods, int n_owners = 1) : wheel_(0, n_owners), n_touching_(n_rods) {}

  /// Numbers are below `n_pairs` from now on.
  void make_room(std::size_t n_pairs);
  void add(int p, const PairRods& rods, std::uint8_t owner);
  void remove(int p);
  bool is_used(int p) const { return pairs_[p].rods != kUnused; }

  /// Asks for what `tighten` needs.
  void prefetch(int p) const {
    shaken::prefetch(pairs_[p]);
    wheel_.prefetch(p);
  }
  const PairRods& rods(int p) const { return pairs_[p].rods; }
  Direction& direction(int p) { return pairs_[p].direction; }
  const Direction& direction(int p) const { return pairs_[p].direction; }
  int owner(int p) const { return pairs_[p].owner; }  ///< the pair's thread

  /// The gap's line of the pair's present bound; `all_round`: along no known direction.
  void set_line(int p, const GapLine& line, bool all_round) {
    pairs_[p].line = line;
    mark(p, kAllRound, all_round);
  }
  /// Brings the pair up sooner, so that its bound holds although the motion of `rod` has changed. False if the bound
  /// had better be made anew; nothing is changed then.
  bool tighten(int p, int rod, const MotionChange& change, Tick now, float dt) {
    Pair& pair = pairs_[p];
    if (!(pair.line.left >= 0.0F)) return false;
    const auto ticks = static_cast<float>(wheel_.due(p, now) - 1 - now);
    if (ticks < 1.0F) return false;
    const float rest = ticks * dt;
    const float faster =
        ((pair.marks & kAllRound) ? change.all_round() : change.along(pair.direction, pair.rods[0] == rod)) +
        change.bending() * rest;
    const float closing = pair.line.closing + faster;
    const float gap = pair.line.left + pair.line.closing * rest - std::max(0.0F, faster) * change.earlier();
    if (gap <= 0.0F) return false;
    if (closing * rest <= gap) {  // due as before
      pair.line.left = std::max(0.0F, gap - closing * rest - GapLine::kRounding);
      pair.line.closing = closing;
      return true;
    }
    constexpr float kFewTicks = 20;  // a bound that is no shorter is worth keeping, or one half as long as it was
    const auto kept = static_cast<int>(gap / (closing * dt) * (1.0F - 1e-5F));
    if (static_cast<float>(kept) < std::min(kFewTicks, 0.5F * ticks + 1.0F)) return false;
    pair.line.left = std::max(0.0F, gap - closing * static_cast<float>(kept) * dt - GapLine::kRounding);
    pair.line.closing = closing;
    set_due(p, now + 1 + kept);
    return true;
  }

  /// Beads overlapped at the last search for contacts.
  bool is_touching(int p) const { return (pairs_[p].marks & kTouching) != 0; }
  void turn_touching(int p);
  int n_touching(int rod) const { return n_touching_[rod]; }  ///< pairs of the rod

  Tick detected_at(int p) const { return detected_at_[p]; }  ///< of the last search for contacts
  void set_detected(int p, Tick now) { detected_at_[p] = now; }

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
  std::size_t bytes() const;

 private:
  enum Mark : std::uint8_t { kTouching = 1, kListed = 2, kAllRound = 4 };
  static constexpr PairRods kUnused{-1, -1};  ///< of a number that the neighbour list does not use

  struct Pair {
    PairRods rods = kUnused;
    Direction direction{};
    GapLine line;
    std::uint8_t marks = 0;
    std::uint8_t owner = 0;
  };

  void mark(int p, Mark what, bool set) {
    pairs_[p].marks = static_cast<std::uint8_t>(set ? pairs_[p].marks | what : pairs_[p].marks & ~what);
  }

  std::vector<Pair> pairs_;
  std::vector<Tick> detected_at_;
  TimingWheel wheel_;
  std::vector<std::int16_t> n_touching_;  ///< (n_rods)
};

}  // namespace shaken
