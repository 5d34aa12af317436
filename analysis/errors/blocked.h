#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/errors/saved.h"
#include "analysis/errors/steady.h"
#include "base/core/series_limits.h"

namespace shaken::analysis {

/// An accumulator kept in stretches of time, so that the steady part can be reduced when its beginning is known only at
/// the end of the run. When the stretches are used up, neighbours are merged and new ones are twice as long.
/// Accumulator: copyable, with accumulate(args...), merge(const Accumulator&), save and restore; where what it
/// takes depends on the number of the sample, also start_at(samples before its first).
template <class Accumulator>
class Blocked : public Saved<Blocked<Accumulator>> {
 public:
  /// Every stretch starts as a copy of `empty`.
  explicit Blocked(Accumulator empty) : empty_(std::move(empty)) {}

  /// accumulate(args...) at `time` [s], later than all before.
  template <class... Args>
  void accumulate(double time, const Args&... args) {
    if (blocks_.empty() || blocks_.back().calls == calls_per_block_) {
      if (blocks_.size() == kMostStretches) merge_pairs();
      std::int64_t samples = 0;
      for (const Block& block : blocks_) samples += block.calls;
      blocks_.push_back({time, 0, empty_});
      if constexpr (requires { blocks_.back().content.start_at(samples); }) blocks_.back().content.start_at(samples);
    }
    blocks_.back().content.accumulate(args...);
    ++blocks_.back().calls;
  }

  /// The samples from `t_steady` [s] on, less those of the stretch that t_steady falls into: at most 1/32 of the run.
  Accumulator after(double t_steady) const {
    Accumulator sum = empty_;
    for (const Block& block : blocks_) {
      if (is_steady(block.start, t_steady)) sum.merge(block.content);
    }
    return sum;
  }
  /// What after() adds up, in order of time, as at most `most` parts of the same number of stretches (the last one may
  /// be shorter): blocks for the errors of what is made of them.
  std::vector<Accumulator> parts_after(double t_steady, std::size_t most) const {
    std::size_t first = 0;
    while (first < blocks_.size() && !is_steady(blocks_[first].start, t_steady)) ++first;
    const std::size_t length = std::max<std::size_t>(1, (blocks_.size() - first + most - 1) / most);
    std::vector<Accumulator> parts;
    for (std::size_t i = first; i < blocks_.size(); ++i) {
      if ((i - first) % length == 0) parts.push_back(empty_);
      parts.back().merge(blocks_[i].content);
    }
    return parts;
  }
  const Accumulator& empty() const { return empty_; }
  /// All samples.
  Accumulator all() const { return after(-std::numeric_limits<double>::max()); }

  static constexpr const char* kName = "Blocked";
  static auto fields(auto& self) {
    return listed(self.calls_per_block_, Length{self.blocks_, Block{0, 0, self.empty_}}, self.blocks_);
  }
  bool is_sound() const {
    const auto is_part = [&](const Block& block) { return block.calls >= 1 && block.calls <= calls_per_block_; };
    return calls_per_block_ >= 1 && blocks_.size() <= kMostStretches && std::ranges::all_of(blocks_, is_part);
  }

 private:
  struct Block {
    double start;        // time of the first sample
    std::int64_t calls;  // samples
    Accumulator content;
    static auto fields(auto& self) { return listed(self.start, self.calls, self.content); }
  };

  void merge_pairs() {
    for (std::size_t i = 0; i < kMostStretches / 2; ++i) {
      Block merged = std::move(blocks_[2 * i]);
      merged.content.merge(blocks_[2 * i + 1].content);
      merged.calls += blocks_[2 * i + 1].calls;
      blocks_[i] = std::move(merged);
    }
    blocks_.erase(blocks_.begin() + kMostStretches / 2, blocks_.end());
    calls_per_block_ *= 2;
  }

  Accumulator empty_;
  std::int64_t calls_per_block_ = 1;
  std::vector<Block> blocks_;  // in order of time; only the last may hold fewer than calls_per_block_ samples
};

}  // namespace shaken::analysis
