#include "sim/schedule/gap_budgets.h"

#include "base/core/heap_bytes.h"
#include "sim/bounds/margins.h"

namespace shaken {
namespace {

constexpr float kEmpty = -1e30F;     ///< no hit returns so much
constexpr float kUnlimited = 1e30F;  ///< no hit spends so much
constexpr float kEndsNow = 1e20F;    ///< spent by any hit where the bound ends at this tick

}  // namespace

struct GapBudgets::SpendKernel {
  const VelocityJump& jump;
  Block& block;
  std::int32_t now;
  float dt;

  template <int W>
  SHAKEN_INLINE std::uint32_t run() const {
    constexpr int kWidth = W < kInBlock ? W : kInBlock;
    std::uint32_t overspent = 0;
    for (int l = 0; l < kInBlock; l += kWidth) overspent |= spend<kWidth>(l) << l;
    return overspent;
  }

  template <int W>
  SHAKEN_INLINE std::uint32_t spend(int l) const {
    using F = lanes::Floats<W>;
    lanes::Ints<W> until;
    __builtin_memcpy(&until, block.until + l, sizeof until);
    const F wait = lanes::not_below_zero(__builtin_convertvector(lanes::difference<W>(until, now), F)) * dt;
    const lanes::Vectors<F> d{lanes::load<W>(block.direction[0] + l), lanes::load<W>(block.direction[1] + l),
                              lanes::load<W>(block.direction[2] + l)};
    const F along = jump.along(d);
    const F speed = lanes::dot(d, d) > 0.5F ? along : lanes::all<W>(jump.any_direction());
    const F more = speed + jump.curvature() * (wait + kMostBeyond * dt);
    const F before = lanes::load<W>(block.remaining + l);
    const F rate = lanes::load<W>(block.rate + l) + more;
    F remaining =
        before - margins::kBudget * lanes::abs(before) - more * wait - (wait > 0.0F ? F{} : lanes::all<W>(kEndsNow));
    lanes::store(block.rate + l, rate);
    if (!jump.has_displaced()) {
      lanes::store(block.remaining + l, remaining);
      return lanes::below_zero(remaining);
    }
    remaining -= lanes::dot(d, d) > 0.5F ? jump.shift_along(d) : lanes::all<W>(jump.shift_in_any_direction());
    lanes::store(block.remaining + l, remaining);
    const F closes = rate * wait;
    const F remaining_now = remaining + closes - margins::kCancelled * (lanes::abs(remaining) + lanes::abs(closes));
    return lanes::below_zero(lanes::smaller(remaining, remaining_now));
  }
};

GapBudgets::GapBudgets(std::size_t n_rods, double dt)
    : first_(n_rods, empty_block()), n_lanes_(n_rods), dt_(static_cast<float>(dt)) {}

GapBudgets::Block GapBudgets::empty_block() {
  Block block{};
  std::fill_n(block.remaining, kInBlock, kUnlimited);
  return block;
}

/// Gives every rod room for one more block.
void GapBudgets::widen() {
  std::vector<Block> wider(first_.size() * (n_further_ + 1), empty_block());
  for (std::size_t b = 0; b < further_.size(); ++b)
    wider[b / n_further_ * (n_further_ + 1) + b % n_further_] = further_[b];
  further_ = std::move(wider);
  ++n_further_;
}

int GapBudgets::add(int rod, int pair) {
  const int lane = n_lanes_[rod];
  if (static_cast<std::size_t>(lane) == (n_further_ + 1) * kInBlock) widen();
  ++n_lanes_[rod];
  block(rod, lane).pair[lane % kInBlock] = pair;
  set_direction(rod, lane, {}, 1);
  set_empty(rod, lane);
  return lane;
}

int GapBudgets::remove(int rod, int lane) {
  const int last = --n_lanes_[rod];
  const Block& from = block(rod, last);
  Block& to = block(rod, lane);
  const int l = last % kInBlock;
  const int m = lane % kInBlock;
  for (int c = 0; c < 3; ++c) to.direction[c][m] = from.direction[c][l];
  to.remaining[m] = from.remaining[l];
  to.rate[m] = from.rate[l];
  to.until[m] = from.until[l];
  to.pair[m] = from.pair[l];
  block(rod, last).remaining[l] = kUnlimited;
  return lane == last ? -1 : to.pair[m];
}

void GapBudgets::set_direction(int rod, int lane, const Direction& direction, float sign) {
  Block& in = block(rod, lane);
  for (std::size_t c = 0; c < 3; ++c) in.direction[c][lane % kInBlock] = sign * direction[c];
}

void GapBudgets::set(int rod, int lane, float budget, float rate, Tick until) {
  Block& in = block(rod, lane);
  in.remaining[lane % kInBlock] = budget;
  in.rate[lane % kInBlock] = rate;
  in.until[lane % kInBlock] = static_cast<std::int32_t>(until);
}

void GapBudgets::set_empty(int rod, int lane) { set(rod, lane, kEmpty, 0, 0); }

void GapBudgets::set_unlimited(int rod, int lane) { set(rod, lane, kUnlimited, 0, 0); }

std::uint32_t GapBudgets::spend_from(Block& block, const VelocityJump& jump, Tick now) const {
  const SpendKernel kernel{jump, block, static_cast<std::int32_t>(now), dt_};
  return lanes::with_widest_vectors(kernel);
}

std::size_t GapBudgets::bytes() const { return heap_bytes(first_, further_, n_lanes_); }

}  // namespace shaken
