// SPDX-License-Identifier: MIT
#include "analysis/tilt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/core/check.h"

namespace shaken::analysis {
namespace {

constexpr std::size_t kMaxBlocks = 40;

}  // namespace

TiltVelocity::TiltVelocity(int bins, double n_z_max) : bins_(bins), n_z_max_(n_z_max) {
  SHAKEN_CHECK(bins >= 1, "a histogram needs a bin");
  SHAKEN_CHECK(n_z_max > 0.0, "the range of n_z must not be empty");
}

void TiltVelocity::accumulate(std::span<const Vec3> directors, std::span<const Vec3> velocities) {
  SHAKEN_CHECK(directors.size() == velocities.size(), "one velocity for each director");
  if (blocks_.empty() || blocks_.back().calls == calls_per_block_) {
    if (blocks_.size() == kMaxBlocks) halve_blocks();
    blocks_.push_back(empty_block());
  }
  Block& block = blocks_.back();
  ++block.calls;
  const double bins_per_unit = bins_ / (2.0 * n_z_max_);
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec3& n = directors[i];
    const Vec3& v = velocities[i];
    const double n_xy = std::hypot(n.x(), n.y());
    if (n_xy == 0.0) continue;
    if (std::abs(n.z()) > n_z_max_) {
      ++block.outside;
      continue;
    }
    const auto place = static_cast<std::size_t>((n.z() + n_z_max_) * bins_per_unit);
    const std::size_t bin = std::min(place, block.counts.size() - 1);  // n_z_max itself belongs to the last bin
    ++block.counts[bin];
    block.along[bin] += (v.x() * n.x() + v.y() * n.y()) / n_xy;
    block.across[bin] += (v.y() * n.x() - v.x() * n.y()) / n_xy;
  }
}

namespace {

struct MeanAndError {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double sem = std::numeric_limits<double>::quiet_NaN();
};

/// Mean of a quantity from its sums and counts per block, and the error of this ratio from the scatter of the blocks'
/// sums about what the mean lets expect for their counts (Cochran, Sampling Techniques, section 6.3).
MeanAndError ratio_of_sums(std::span<const double> sums, std::span<const double> counts) {
  double sum = 0, count = 0, n_blocks = 0;
  for (std::size_t b = 0; b < sums.size(); ++b) {
    sum += sums[b];
    count += counts[b];
    if (counts[b] > 0) ++n_blocks;
  }
  MeanAndError result;
  if (count == 0) return result;
  result.mean = sum / count;
  if (n_blocks < 2) return result;
  double squares = 0;
  for (std::size_t b = 0; b < sums.size(); ++b) squares += std::pow(sums[b] - result.mean * counts[b], 2);
  result.sem = std::sqrt(squares * n_blocks / (n_blocks - 1)) / count;
  return result;
}

}  // namespace

TiltCurve TiltVelocity::reduce() const {
  double total = 0;
  for (const Block& block : blocks_) {
    total += static_cast<double>(block.outside);
    for (const std::int64_t count : block.counts) total += static_cast<double>(count);
  }
  const double width = 2.0 * n_z_max_ / bins_;
  TiltCurve curve;
  std::vector<double> counts(blocks_.size()), along(blocks_.size()), across(blocks_.size());
  for (std::size_t bin = 0; bin < static_cast<std::size_t>(bins_); ++bin) {
    double in_bin = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      counts[b] = static_cast<double>(blocks_[b].counts[bin]);
      along[b] = blocks_[b].along[bin];
      across[b] = blocks_[b].across[bin];
      in_bin += counts[b];
    }
    const MeanAndError v_along = ratio_of_sums(along, counts);
    const MeanAndError v_across = ratio_of_sums(across, counts);
    curve.n_z.push_back(-n_z_max_ + (static_cast<double>(bin) + 0.5) * width);
    curve.v_along.push_back(v_along.mean);
    curve.v_along_sem.push_back(v_along.sem);
    curve.v_across.push_back(v_across.mean);
    curve.v_across_sem.push_back(v_across.sem);
    curve.density.push_back(total > 0 ? in_bin / (total * width) : 0.0);
  }
  return curve;
}

void TiltVelocity::reset() {
  blocks_.clear();
  calls_per_block_ = 1;
}

void TiltVelocity::merge(const TiltVelocity& other) {
  SHAKEN_CHECK(bins_ == other.bins_ && n_z_max_ == other.n_z_max_, "tilt curves of different bins");
  calls_per_block_ = std::max(calls_per_block_, other.calls_per_block_);
  blocks_.insert(blocks_.end(), other.blocks_.begin(), other.blocks_.end());
  while (blocks_.size() > kMaxBlocks) halve_blocks();
}

void TiltVelocity::save(StateWriter& writer) const {
  writer.tag("TiltVelocity");
  writer.put(n_z_max_);
  writer.put(calls_per_block_);
  writer.put(static_cast<std::int64_t>(blocks_.size()));
  for (const Block& block : blocks_) {
    writer.put(block.calls);
    writer.put(block.outside);
    writer.put(block.counts);
    writer.put(block.along);
    writer.put(block.across);
  }
}

void TiltVelocity::restore(StateReader& reader) {
  reader.tag("TiltVelocity");
  if (reader.real() != n_z_max_) throw StateError("saved analysis state: TiltVelocity of another range of n_z");
  const std::int64_t calls_per_block = reader.integer(1, std::numeric_limits<std::int64_t>::max() / 2);
  std::vector<Block> blocks(static_cast<std::size_t>(reader.integer(0, kMaxBlocks)));
  const auto bins = static_cast<std::size_t>(bins_);
  for (Block& block : blocks) {
    block.calls = reader.integer(0, calls_per_block);
    block.outside = reader.integer();
    block.counts = reader.integers(bins);
    block.along = reader.reals(bins);
    block.across = reader.reals(bins);
  }
  calls_per_block_ = calls_per_block;
  blocks_ = std::move(blocks);
}

void TiltVelocity::Block::add(const Block& other) {
  calls += other.calls;
  outside += other.outside;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts[i] += other.counts[i];
    along[i] += other.along[i];
    across[i] += other.across[i];
  }
}

TiltVelocity::Block TiltVelocity::empty_block() const {
  const auto bins = static_cast<std::size_t>(bins_);
  return {0, 0, std::vector<std::int64_t>(bins), std::vector<double>(bins), std::vector<double>(bins)};
}

void TiltVelocity::halve_blocks() {
  std::vector<Block> halved;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (i % 2 == 0) {
      halved.push_back(std::move(blocks_[i]));
    } else {
      halved.back().add(blocks_[i]);
    }
  }
  blocks_ = std::move(halved);
  calls_per_block_ *= 2;
}

}  // namespace shaken::analysis
