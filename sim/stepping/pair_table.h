// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/stepping/timing_wheel.h"

namespace shaken {

/// In which direction a pair's hulls were apart at the last bound; 0: not known.
using Direction = std::array<float, 3>;
using PairRods = std::array<int, 2>;

/// What the scheduled stepper knows of the pairs in the neighbour list, under the numbers that the list gives them.
class PairTable {
 public:
  explicit PairTable(std::size_t n_rods) : n_touching_(n_rods), n_unperturbed_(n_rods) {}

  /// Numbers are below `n_pairs` from now on.
  void make_room(std::size_t n_pairs);
  void add(int p, const PairRods& rods, std::uint8_t owner);
  void remove(int p);
  bool is_used(int p) const { return rods_[p] != kUnused; }

  const PairRods& rods(int p) const { return rods_[p]; }
  Direction& direction(int p) { return directions_[p]; }
  const Direction& direction(int p) const { return directions_[p]; }
  /// The thread of each pair.
  const std::vector<std::uint8_t>& owners() const { return owners_; }

  /// Beads overlapped at the last search for contacts.
  bool is_touching(int p) const { return (marks_[p] & kTouching) != 0; }
  void turn_touching(int p);
  int n_touching(int rod) const { return n_touching_[rod]; }  ///< pairs of the rod

  /// The bound holds for unperturbed flight only.
  bool is_unperturbed(int p) const { return (marks_[p] & kUnperturbed) != 0; }
  void set_unperturbed(int p, bool unperturbed);
  int n_unperturbed(int rod) const { return n_unperturbed_[rod]; }  ///< pairs of the rod

  Tick detected_at(int p) const { return detected_at_[p]; }  ///< of the last search for contacts
  void set_detected(int p, Tick now) { detected_at_[p] = now; }

  /// Puts pairs on a list once: appends p unless it is there already.
  void list(int p, std::vector<int>& pairs) {
    if (marks_[p] & kListed) return;
    marks_[p] |= kListed;
    pairs.push_back(p);
  }
  void unlist(int p) { marks_[p] &= static_cast<std::uint8_t>(~kListed); }

  TimingWheel& wheel() { return wheel_; }
  std::size_t bytes() const;

 private:
  enum Mark : std::uint8_t { kUnperturbed = 1, kTouching = 2, kListed = 4 };
  static constexpr PairRods kUnused{-1, -1};  ///< of a number that the neighbour list does not use

  std::vector<PairRods> rods_;
  std::vector<Direction> directions_;
  std::vector<Tick> detected_at_;
  std::vector<std::uint8_t> marks_;
  std::vector<std::uint8_t> owners_;
  TimingWheel wheel_;
  std::vector<std::int16_t> n_touching_, n_unperturbed_;  ///< (n_rods)
};

}  // namespace shaken
