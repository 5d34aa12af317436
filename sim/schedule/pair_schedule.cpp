#include "sim/schedule/pair_schedule.h"

#include <algorithm>
#include <cmath>

#include "base/core/heap_bytes.h"
#include "sim/bounds/margins.h"

namespace shaken {
namespace {

// The price of other values is in instructions of the whole, at area fractions of 0.75 and 0.45 (callgrind, AVX2, 6,000
// ticks of 527 and 316 rods).

/// A pair comes up this part of its bound's time before the bound ends: the budget for hits.
/// 4: 0.1 and 0.0 % more; 16: 1.0 and 0.1 % more, since more bounds must be shortened.
constexpr int kPartKept = 8;

/// A part of fewer ticks than this is not kept: it buys too few hits for a visit that much sooner.
/// 1: 0.5 and 0.2 % more; 8: 0.3 % more, and 0.1 % less.
constexpr int kLeastKept = 3;

/// A shortened bound of this many ticks is worth keeping, and so is one half as long as before.
/// 5: 0.1 and 0.0 % more; 60: 0.2 and 0.0 % more.
constexpr int kFewTicks = 20;

/// When a bound is shortened, the rod that has spent more gets this part of the budget. It is likely to spend more
/// again, as a rod at rest does, which the base hits at every tick.
constexpr float kPartOfSpender = 0.85F;

void count(std::vector<std::int16_t>& counts, const PairRods& rods, bool up) {
  for (const int i : rods) counts[i] = static_cast<std::int16_t>(counts[i] + (up ? 1 : -1));
}

/// Ticks from `now` to `then`, of which the last 32 bits are known.
int ticks_to(std::int32_t then, Tick now) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(then) - static_cast<std::uint32_t>(now));
}

}  // namespace

PairSchedule::PairSchedule(std::size_t n_rods, double dt, int n_owners)
    : wheel_(0, n_owners), budgets_(n_rods, dt), n_touching_(n_rods), dt_(static_cast<float>(dt)) {}

void PairSchedule::make_room(std::size_t n_pairs) {
  pairs_.resize(n_pairs);
  searched_at_.resize(n_pairs, -1);
  wheel_.make_room(n_pairs);
}

void PairSchedule::add(int p, const PairRods& rods, std::uint8_t owner) {
  Pair& pair = pairs_[p];
  pair.rods = rods;
  pair.direction = {};
  pair.owner = owner;
  mark(p, kSurvivesHits, false);
  for (std::size_t r = 0; r < 2; ++r) pair.lanes[r] = static_cast<std::uint16_t>(budgets_.add(rods[r], p));
  searched_at_[p] = -1;
}

void PairSchedule::remove(int p) {
  Pair& pair = pairs_[p];
  if (!is_used(p)) return;
  if (is_touching(p)) toggle_touching(p);  // it was at its last visit; by now it certainly is not
  for (std::size_t r = 0; r < 2; ++r) {
    const int rod = pair.rods[r];
    const int moved = budgets_.remove(rod, pair.lanes[r]);
    if (moved >= 0) pairs_[moved].lanes[pairs_[moved].rods[0] == rod ? 0 : 1] = pair.lanes[r];
  }
  pair.rods = kUnused;
  wheel_.remove(p);
}

/// What remains of a bound.
struct PairSchedule::Remaining {
  int ticks;                   ///< for which it holds
  float gap;                   ///< now [mm]
  float rate;                  ///< at which it closes [mm/s]
  float part_of_first = 0.5F;  ///< of what hits may spend, that of the pair's first rod
};

void PairSchedule::set_bound(int p, Tick now, int ticks, const Direction& direction, const GapBound& gap) {
  Pair& pair = pairs_[p];
  const bool survives_hits = gap.residual >= 0.0F;
  mark(p, kSurvivesHits, survives_hits);
  pair.direction = direction;
  for (std::size_t r = 0; r < 2; ++r) {
    const float sign = r == 0 ? 1.0F : -1.0F;
    budgets_.set_direction(pair.rods[r], pair.lanes[r], direction, gap.isotropic ? 0.0F : sign);
    if (!survives_hits) budgets_.set_empty(pair.rods[r], pair.lanes[r]);
  }
  if (survives_hits) {
    set_budgets(p, now, {ticks, gap.residual + gap.rate * (static_cast<float>(ticks) * dt_), gap.rate});
  } else {
    set_due(p, now + 1 + ticks);
  }
}

void PairSchedule::poll(int p, Tick now) {
  mark(p, kSurvivesHits, false);
  for (std::size_t r = 0; r < 2; ++r) budgets_.set_unlimited(pairs_[p].rods[r], pairs_[p].lanes[r]);
  set_due(p, now + 1);
}

void PairSchedule::set_budgets(int p, Tick now, const Remaining& bound) {
  Pair& pair = pairs_[p];
  const int kept = std::min(bound.ticks / kPartKept, GapBudgets::kMostBeyond);
  const int waits = bound.ticks - (kept < kLeastKept ? 0 : kept);
  const Tick until = now + waits;
  const float gap_at_until =
      bound.gap - bound.rate * (static_cast<float>(waits) * dt_) - margins::rounding_of_gap(bound.gap);
  pair.end = static_cast<std::int32_t>(now + bound.ticks);
  pair.until = static_cast<std::int32_t>(until);
  for (std::size_t r = 0; r < 2; ++r) {
    const float part = r == 0 ? bound.part_of_first : 1.0F - bound.part_of_first;
    budgets_.set(pair.rods[r], pair.lanes[r], part * std::max(0.0F, gap_at_until), 0.5F * bound.rate, until);
  }
  set_due(p, until + 1);
}

PairSchedule::Remaining PairSchedule::remaining(int p, Tick now) const {
  const Pair& pair = pairs_[p];
  const int most = ticks_to(pair.end, now);
  if ((pair.marks & kSurvivesHits) == 0 || most < 0) return {0, 0, 0};
  float rate = 0;
  std::array<float, 2> budgets;
  for (std::size_t r = 0; r < 2; ++r) {
    rate += budgets_.rate(pair.rods[r], pair.lanes[r]);
    budgets[r] = budgets_.remaining(pair.rods[r], pair.lanes[r]);
  }
  const float budget = budgets[0] + budgets[1];
  const float more_now = rate * (static_cast<float>(ticks_to(pair.until, now)) * dt_);
  const float gap = budget + more_now - margins::kCancelled * (std::abs(budget) + std::abs(more_now));
  if (!(gap > 0.0F)) return {0, 0, 0};
  const float part = budgets[0] < budgets[1] ? kPartOfSpender : 1.0F - kPartOfSpender;
  if (rate * (static_cast<float>(most) * dt_) <= gap) return {most, gap, rate, part};
  return {static_cast<int>(gap / (rate * dt_) * (1.0F - margins::kTime)), gap, rate, part};
}

bool PairSchedule::shorten_bound(int p, Tick now) {
  const int waiting = ticks_to(pairs_[p].until, now);
  const Remaining bound = remaining(p, now);
  if (waiting < 1 || bound.ticks < std::min(kFewTicks, waiting / 2 + 1)) return false;
  set_budgets(p, now, bound);
  return true;
}

bool PairSchedule::is_apart(int p, Tick now) const { return !is_touching(p) && remaining(p, now).gap > 0.0F; }

void PairSchedule::toggle_touching(int p) {
  pairs_[p].marks ^= kTouching;
  count(n_touching_, pairs_[p].rods, is_touching(p));
}

std::size_t PairSchedule::bytes() const {
  return wheel_.bytes() + budgets_.bytes() + heap_bytes(pairs_, searched_at_, n_touching_);
}

}  // namespace shaken
