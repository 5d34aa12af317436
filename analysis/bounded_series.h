// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/core/check.h"
#include "base/core/state_io.h"

namespace shaken::analysis {

/// Columns of numbers against time, in bounded memory: when `max_points` points are kept, neighbours are averaged in
/// pairs (their times too), and from then on a point is the mean of twice as many samples. Points stay equally spaced
/// if the samples are. The mean of a column keeps its meaning; its spread is from then on that of the averaged points.
/// Samples of a point not yet complete are counted once it is.
template <std::size_t Columns>
class BoundedSeries {
 public:
  static constexpr std::size_t kMaxPoints = 65536;
  explicit BoundedSeries(std::size_t max_points = kMaxPoints) : max_points_(max_points) {
    SHAKEN_CHECK(max_points >= 2 && max_points % 2 == 0, "points are averaged in pairs");
  }

  /// At `time` [s], later than all before.
  void accumulate(double time, const std::array<double, Columns>& values) {
    SHAKEN_CHECK(time > last_time_, "samples must come in order of time");
    last_time_ = time;
    pending_[0] += time;
    for (std::size_t k = 0; k < Columns; ++k) pending_[k + 1] += values[k];
    if (++pending_samples_ < samples_per_point_) return;
    for (std::size_t k = 0; k <= Columns; ++k) {
      columns_[k].push_back(pending_[k] / static_cast<double>(pending_samples_));
    }
    pending_ = {};
    pending_samples_ = 0;
    if (columns_[0].size() == max_points_) average_pairs();
  }

  const std::vector<double>& times() const { return columns_[0]; }                    ///< (n) [s]
  const std::vector<double>& column(std::size_t k) const { return columns_[k + 1]; }  ///< (n)

  void save(StateWriter& writer) const {
    writer.tag("BoundedSeries");
    writer.put(samples_per_point_);
    writer.put(pending_samples_);
    writer.put(last_time_);
    writer.put(pending_);
    for (const std::vector<double>& column : columns_) writer.put(column);
  }

  void restore(StateReader& reader) {
    reader.tag("BoundedSeries");
    BoundedSeries saved(max_points_);
    saved.samples_per_point_ = reader.integer(1, std::numeric_limits<std::int64_t>::max() / 4);
    saved.pending_samples_ = reader.integer(0, saved.samples_per_point_ - 1);
    saved.last_time_ = reader.real();
    const std::vector<double> pending = reader.reals(Columns + 1);
    std::copy(pending.begin(), pending.end(), saved.pending_.begin());
    saved.columns_[0] = reader.reals();
    if (saved.columns_[0].size() >= max_points_) throw StateError("BoundedSeries overfull");
    for (std::size_t k = 1; k <= Columns; ++k) saved.columns_[k] = reader.reals(saved.columns_[0].size());
    *this = std::move(saved);
  }

 private:
  void average_pairs() {
    for (std::vector<double>& column : columns_) {
      for (std::size_t i = 0; i < column.size() / 2; ++i) column[i] = (column[2 * i] + column[2 * i + 1]) / 2;
      column.resize(column.size() / 2);
    }
    samples_per_point_ *= 2;
  }

  std::size_t max_points_;
  std::int64_t samples_per_point_ = 1;
  std::array<std::vector<double>, Columns + 1> columns_;  // times first
  std::array<double, Columns + 1> pending_{};             // sums of the point being made
  std::int64_t pending_samples_ = 0;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace shaken::analysis
