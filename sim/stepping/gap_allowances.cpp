// SPDX-License-Identifier: MIT
#include "sim/stepping/gap_allowances.h"

#include "base/core/heap_bytes.h"

namespace shaken {
namespace {

constexpr float kNothingAllowed = -1e30F;  ///< no hit gives so much back
constexpr float kAllAllowed = 1e30F;       ///< no hit takes so much
constexpr float kEndsNow = 1e20F;          ///< what any hit takes where the bound ends at this tick
/// Of an allowance, for each time that something is taken from it: the rounding of floats.
constexpr float kRoundingOfFloats = 1e-6F;

}  // namespace

struct GapAllowances::TakeKernel {
  const MotionChange& change;
  Block& block;
  std::int32_t now;
  float dt;

  template <int W>
  SHAKEN_INLINE std::uint32_t run() const {
    constexpr int kWidth = W < kInBlock ? W : kInBlock;
    std::uint32_t used_up = 0;
    for (int l = 0; l < kInBlock; l += kWidth) used_up |= take<kWidth>(l) << l;
    return used_up;
  }

  template <int W>
  SHAKEN_INLINE std::uint32_t take(int l) const {
    using F = lanes::Floats<W>;
    lanes::Ints<W> until;
    __builtin_memcpy(&until, block.until + l, sizeof until);
    const F rest = lanes::not_below_zero(__builtin_convertvector(lanes::difference<W>(until, now), F)) * dt;
    const lanes::Vectors<F> d{lanes::load<W>(block.direction[0] + l), lanes::load<W>(block.direction[1] + l),
                              lanes::load<W>(block.direction[2] + l)};
    const F along = change.along(d);
    const F speed = lanes::dot(d, d) > 0.5F ? along : lanes::all<W>(change.all_round());
    const F more = speed + change.bending() * (rest + kMostBeyond * dt + change.earlier());
    const F before = lanes::load<W>(block.left + l);
    const F left = before - kRoundingOfFloats * lanes::abs(before) - more * rest -
                   lanes::not_below_zero(more) * change.earlier() - (rest > 0.0F ? F{} : lanes::all<W>(kEndsNow));
    lanes::store(block.left + l, left);
    lanes::store(block.faster + l, lanes::load<W>(block.faster + l) + more);
    return lanes::below_zero(left);
  }
};

GapAllowances::GapAllowances(std::size_t n_rods, double dt)
    : first_(n_rods, empty_block()), n_lanes_(n_rods), dt_(static_cast<float>(dt)) {}

GapAllowances::Block GapAllowances::empty_block() {
  Block block{};
  std::fill_n(block.left, kInBlock, kAllAllowed);
  return block;
}

/// Gives every rod room for one more block.
void GapAllowances::widen() {
  std::vector<Block> wider(first_.size() * (n_further_ + 1), empty_block());
  for (std::size_t b = 0; b < further_.size(); ++b)
    wider[b / n_further_ * (n_further_ + 1) + b % n_further_] = further_[b];
  further_ = std::move(wider);
  ++n_further_;
}

int GapAllowances::add(int rod, int pair) {
  const int lane = n_lanes_[rod];
  if (static_cast<std::size_t>(lane) == (n_further_ + 1) * kInBlock) widen();
  ++n_lanes_[rod];
  block(rod, lane).pair[lane % kInBlock] = pair;
  set_direction(rod, lane, {}, 1);
  forbid(rod, lane);
  return lane;
}

int GapAllowances::remove(int rod, int lane) {
  const int last = --n_lanes_[rod];
  const Block& from = block(rod, last);
  Block& to = block(rod, lane);
  const int l = last % kInBlock;
  const int m = lane % kInBlock;
  for (int c = 0; c < 3; ++c) to.direction[c][m] = from.direction[c][l];
  to.left[m] = from.left[l];
  to.faster[m] = from.faster[l];
  to.until[m] = from.until[l];
  to.pair[m] = from.pair[l];
  block(rod, last).left[l] = kAllAllowed;
  return lane == last ? -1 : to.pair[m];
}

void GapAllowances::set_direction(int rod, int lane, const Direction& direction, float sign) {
  Block& in = block(rod, lane);
  for (std::size_t c = 0; c < 3; ++c) in.direction[c][lane % kInBlock] = sign * direction[c];
}

void GapAllowances::allow(int rod, int lane, float allowance, Tick until) {
  Block& in = block(rod, lane);
  in.left[lane % kInBlock] = allowance;
  in.faster[lane % kInBlock] = 0;
  in.until[lane % kInBlock] = static_cast<std::int32_t>(until);
}

void GapAllowances::forbid(int rod, int lane) { allow(rod, lane, kNothingAllowed, 0); }

void GapAllowances::allow_all(int rod, int lane) { allow(rod, lane, kAllAllowed, 0); }

std::uint32_t GapAllowances::take_from(Block& block, const MotionChange& change, Tick now) const {
  const TakeKernel kernel{change, block, static_cast<std::int32_t>(now), dt_};
  return lanes::with_widest_vectors(kernel);
}

std::size_t GapAllowances::bytes() const { return heap_bytes(first_, further_, n_lanes_); }

}  // namespace shaken
