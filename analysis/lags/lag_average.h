#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "analysis/errors/saved.h"
#include "analysis/lags/lag_curve.h"
#include "analysis/lags/lag_sums.h"
#include "base/core/check.h"
#include "base/core/state_io.h"

namespace shaken::analysis {

/// One sample: `columns` numbers of each rod, and the angle of the nematic director of all rods [rad].
template <std::size_t columns>
struct LagFrame {
  std::array<std::vector<double>, columns> column;  // each (n_rods)
  double director = 0;
  static auto fields(auto& self) { return listed(Growing{self.column}, self.director); }
};

/// What a pair of samples gives: how many rods counted, and sums over them.
template <std::size_t quantities>
struct LagPair {
  double rods = 0;
  std::array<double, quantities> sums{};
};

/// Averages over pairs of samples against the lag between them, while the run goes on.
/// Level k of `n_levels` keeps the last 8 of every 2^k-th sample and gives the lags (1..8 for k = 0, 5..8 else) 2^k:
/// four an octave up to 8 * 2^(n_levels - 1) samples, exact, with every 2^k-th sample as an origin. Memory is at most
/// 64 bytes per level, rod and column, however long the run, and some hundred kilobytes of sums.
/// Kernel: static constexpr kName, kColumns, kQuantities, kLagZero (whether a sample is also paired with itself);
///   static LagPair<kQuantities> between(const LagFrame<kColumns>& origin, const LagFrame<kColumns>& later).
template <class Kernel>
class LagAverage {
 public:
  using Frame = LagFrame<Kernel::kColumns>;

  /// `interval`: time between successive samples [s].
  explicit LagAverage(double interval, int n_levels = 16)
      : interval_(interval),
        levels_(static_cast<std::size_t>(std::clamp(n_levels, 0, kMaxLevels))),
        sums_(lags_of(levels_.size()), Kernel::kQuantities) {
    SHAKEN_CHECK(interval > 0.0, "samples must follow each other");
    SHAKEN_CHECK(n_levels >= 1 && n_levels <= kMaxLevels, "between 1 and 48 levels");
  }

  double interval() const { return interval_; }
  /// Samples so far.
  std::int64_t samples() const { return samples_; }
  /// The last sample; there must be one.
  const Frame& last() const { return levels_[0].frames[static_cast<std::size_t>((levels_[0].n_frames - 1) % kFrames)]; }

  /// Takes a sample at `time` [s], one interval after the last; the number of rods is the same in every call.
  void accumulate(double time, Frame frame) {
    if (samples_ == 0) start_ = time;
    SHAKEN_CHECK(std::abs(time - start_ - static_cast<double>(samples_) * interval_) < 0.25 * interval_,
                 "samples must be one interval apart");
    for (const std::vector<double>& column : frame.column) {
      SHAKEN_CHECK(column.size() == (samples_ == 0 ? frame.column[0].size() : n_rods()), "as many rods as before");
    }
    if constexpr (Kernel::kLagZero) add(samples_, 0, Kernel::between(frame, frame));
    for (std::size_t k = 0; k < levels_.size() && samples_ % (std::int64_t{1} << k) == 0; ++k) {
      const Level& level = levels_[k];
      const std::int64_t longest = std::min<std::int64_t>(level.n_frames, kFrames);
      for (std::int64_t lag = shortest(k); lag <= longest; ++lag) {
        const std::int64_t origin = level.n_frames - lag;
        add(origin << k, place(k, lag),
            Kernel::between(level.frames[static_cast<std::size_t>(origin % kFrames)], frame));
      }
      // The last level to take the sample may have it.
      const bool last = k + 1 == levels_.size() || samples_ % (std::int64_t{1} << (k + 1)) != 0;
      if (last) {
        keep(k, std::move(frame));
        break;
      }
      keep(k, frame);
    }
    ++samples_;
  }

  /// Averages over the origins from `t_steady` [s] on, less those of the stretch of origins that it falls into: at most
  /// 1/32 of the run.
  LagCurve after(double t_steady) const { return sums_.after(t_steady, start_, interval_); }
  LagCurve all() const { return after(-std::numeric_limits<double>::max()); }

  void save(StateWriter& writer) const {
    writer.tag(Kernel::kName);
    writer.put(interval_);
    writer.put(start_);
    writer.put(samples_);
    writer.put(static_cast<std::int64_t>(n_rods()));
    sums_.save(writer);
    for (const Level& level : levels_) {
      for (const Frame& frame : level.frames) {
        for (const std::vector<double>& column : frame.column) writer.put(column);
        writer.put(frame.director);
      }
    }
  }

  void restore(StateReader& reader) {
    reader.tag(Kernel::kName);
    if (reader.real() != interval_) {
      throw StateError(std::string(Kernel::kName) + " of another interval");
    }
    LagAverage saved(interval_, static_cast<int>(levels_.size()));
    saved.start_ = reader.real();
    saved.samples_ = reader.integer(0, std::numeric_limits<std::int64_t>::max() / 2);
    const auto n_rods = static_cast<std::size_t>(reader.integer());
    saved.sums_.restore(reader);
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      Level& level = saved.levels_[k];
      level.n_frames = (saved.samples_ + (std::int64_t{1} << k) - 1) >> k;  // every 2^k-th sample
      level.frames.resize(static_cast<std::size_t>(std::min<std::int64_t>(level.n_frames, kFrames)));
      for (Frame& frame : level.frames) {
        for (std::vector<double>& column : frame.column) column = reader.reals(n_rods);
        frame.director = reader.real();
      }
    }
    *this = std::move(saved);
  }

 private:
  static constexpr int kFrames = 8;
  static constexpr int kMaxLevels = 48;
  struct Level {
    std::vector<Frame> frames;  // the last kFrames samples; sample f is at f % kFrames
    std::int64_t n_frames = 0;  // taken so far
  };

  static std::int64_t shortest(std::size_t level) { return level == 0 ? 1 : kFrames / 2 + 1; }
  /// Number of a lag among those of lags_of.
  static std::size_t place(std::size_t level, std::int64_t lag) {
    const std::size_t before = level == 0 ? 1 : 1 + kFrames + (level - 1) * (kFrames / 2);
    return before + static_cast<std::size_t>(lag - shortest(level));
  }
  static std::vector<SampledLag> lags_of(std::size_t n_levels) {
    std::vector<SampledLag> lags{{0, 1}};
    for (std::size_t k = 0; k < n_levels; ++k) {
      for (std::int64_t lag = shortest(k); lag <= kFrames; ++lag) lags.push_back({lag << k, std::int64_t{1} << k});
    }
    return lags;
  }

  std::size_t n_rods() const { return samples_ == 0 ? 0 : last().column[0].size(); }
  void add(std::int64_t origin, std::size_t lag, const LagPair<Kernel::kQuantities>& pair) {
    sums_.add(origin, lag, pair.rods, pair.sums);
  }
  template <class AFrame>
  void keep(std::size_t k, AFrame&& frame) {
    Level& level = levels_[k];
    const auto place = static_cast<std::size_t>(level.n_frames % kFrames);
    if (level.frames.size() <= place) level.frames.emplace_back();
    level.frames[place] = std::forward<AFrame>(frame);
    ++level.n_frames;
  }

  double interval_;
  double start_ = 0;  // time of the first sample [s]
  std::int64_t samples_ = 0;
  std::vector<Level> levels_;
  LagSums sums_;
};

}  // namespace shaken::analysis
