// SPDX-License-Identifier: MIT
#include "sim/stepping/pair_table.h"

#include <algorithm>
#include <cmath>

#include "base/core/heap_bytes.h"

namespace shaken {
namespace {

/// A pair comes up this part of its bound's time before that ends.
constexpr int kPartKept = 8;

/// With less left than this, a pair that comes up is searched [ticks].
constexpr int kWorthWaiting = 8;

void count(std::vector<std::int16_t>& counts, const PairRods& rods, bool up) {
  for (const int i : rods) counts[i] = static_cast<std::int16_t>(counts[i] + (up ? 1 : -1));
}

/// Ticks from `now` to `then`, of which the last 32 bits are known.
int ticks_to(std::int32_t then, Tick now) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(then) - static_cast<std::uint32_t>(now));
}

}  // namespace

PairTable::PairTable(std::size_t n_rods, double dt, int n_owners)
    : wheel_(0, n_owners), allowances_(n_rods, dt), n_touching_(n_rods), dt_(static_cast<float>(dt)) {}

void PairTable::make_room(std::size_t n_pairs) {
  pairs_.resize(n_pairs);
  detected_at_.resize(n_pairs, -1);
  wheel_.make_room(n_pairs);
}

void PairTable::add(int p, const PairRods& rods, std::uint8_t owner) {
  Pair& pair = pairs_[p];
  pair.rods = rods;
  pair.direction = {};
  pair.owner = owner;
  mark(p, kHasLine, false);
  for (std::size_t r = 0; r < 2; ++r) pair.lanes[r] = static_cast<std::uint16_t>(allowances_.add(rods[r], p));
  detected_at_[p] = -1;
}

void PairTable::remove(int p) {
  Pair& pair = pairs_[p];
  if (!is_used(p)) return;
  if (is_touching(p)) turn_touching(p);  // it was at its last visit; by now it certainly is not
  for (std::size_t r = 0; r < 2; ++r) {
    const int rod = pair.rods[r];
    const int moved = allowances_.remove(rod, pair.lanes[r]);
    if (moved >= 0) pairs_[moved].lanes[pairs_[moved].rods[0] == rod ? 0 : 1] = pair.lanes[r];
  }
  pair.rods = kUnused;
  wheel_.remove(p);
}

/// What is left of a bound.
struct PairTable::Remaining {
  int ticks;      ///< for which it holds
  float gap;      ///< now [mm]
  float closing;  ///< [mm/s]
};

void PairTable::hold(int p, Tick now, int ticks, const Direction& direction, const GapLine& line) {
  Pair& pair = pairs_[p];
  const bool has_line = line.left >= 0.0F;
  mark(p, kHasLine, has_line);
  pair.direction = direction;
  for (std::size_t r = 0; r < 2; ++r) {
    const float sign = r == 0 ? 1.0F : -1.0F;
    allowances_.set_direction(pair.rods[r], pair.lanes[r], direction, line.all_round ? 0.0F : sign);
    if (!has_line) allowances_.forbid(pair.rods[r], pair.lanes[r]);
  }
  if (has_line) {
    allow(p, now, {ticks, line.left + line.closing * (static_cast<float>(ticks) * dt_), line.closing});
  } else {
    set_due(p, now + 1 + ticks);
  }
}

void PairTable::search_again(int p, Tick now) {
  mark(p, kHasLine, false);
  for (std::size_t r = 0; r < 2; ++r) allowances_.allow_all(pairs_[p].rods[r], pairs_[p].lanes[r]);
  set_due(p, now + 1);
}

void PairTable::allow(int p, Tick now, const Remaining& bound) {
  Pair& pair = pairs_[p];
  const int waits = bound.ticks - std::min(bound.ticks / kPartKept, GapAllowances::kMostBeyond);
  const Tick until = now + waits;
  const float left = bound.gap - bound.closing * (static_cast<float>(waits) * dt_) - GapLine::rounding(bound.gap);
  pair.closing = bound.closing;
  pair.end = static_cast<std::int32_t>(now + bound.ticks);
  pair.until = static_cast<std::int32_t>(until);
  for (std::size_t r = 0; r < 2; ++r)
    allowances_.allow(pair.rods[r], pair.lanes[r], 0.5F * std::max(0.0F, left), until);
  set_due(p, until + 1);
}

PairTable::Remaining PairTable::remaining(int p, Tick now) const {
  const Pair& pair = pairs_[p];
  if ((pair.marks & kHasLine) == 0) return {0, 0, 0};
  float closing = pair.closing;
  float left = 0;
  for (std::size_t r = 0; r < 2; ++r) {
    closing += allowances_.faster(pair.rods[r], pair.lanes[r]);
    left += allowances_.left(pair.rods[r], pair.lanes[r]);
  }
  const float more_now = closing * (static_cast<float>(ticks_to(pair.until, now)) * dt_);
  constexpr float kCancelled = 1e-6F;  // both are rounded, and may nearly cancel
  const float gap = left + more_now - kCancelled * (std::abs(left) + std::abs(more_now));
  const int most = std::max(0, ticks_to(pair.end, now));
  if (!(gap > 0.0F)) return {0, 0, 0};
  if (closing * (static_cast<float>(most) * dt_) <= gap) return {most, gap, closing};
  return {static_cast<int>(gap / (closing * dt_) * (1.0F - 1e-5F)), gap, closing};
}

int PairTable::ticks_left(int p, Tick now) const { return remaining(p, now).ticks; }

bool PairTable::settle(int p, Tick now) {
  const int waiting = ticks_to(pairs_[p].until, now);
  const Remaining bound = remaining(p, now);
  constexpr int kFewTicks = 20;  // a bound that is no shorter is worth keeping, or one half as long as it was
  if (waiting < 1 || bound.ticks < std::min(kFewTicks, waiting / 2 + 1)) return false;
  allow(p, now, bound);
  return true;
}

bool PairTable::waits_on(int p, Tick now) {
  const Remaining bound = remaining(p, now);
  if (bound.ticks < kWorthWaiting) return false;
  allow(p, now, bound);
  return true;
}

void PairTable::turn_touching(int p) {
  pairs_[p].marks ^= kTouching;
  count(n_touching_, pairs_[p].rods, is_touching(p));
}

std::size_t PairTable::bytes() const {
  return wheel_.bytes() + allowances_.bytes() + heap_bytes(pairs_, detected_at_, n_touching_);
}

}  // namespace shaken
