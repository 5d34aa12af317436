#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/errors/saved.h"
#include "base/core/check.h"
#include "base/core/series_limits.h"

namespace shaken::analysis {

/// Columns of numbers against time, in bounded memory: when `max_points` points are kept, neighbours are averaged in
/// pairs (their times too), and from then on a point is the mean of twice as many samples. Points stay equally spaced
/// if the samples are. The mean of a column keeps its meaning; its spread is from then on that of the averaged points.
/// Samples of a point not yet complete are counted once it is.
template <std::size_t Columns>
class BoundedSeries : public Saved<BoundedSeries<Columns>> {
 public:
  explicit BoundedSeries(std::size_t max_points = kMostSeriesPoints) : max_points_(max_points) {
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

  static constexpr const char* kName = "BoundedSeries";
  static auto fields(auto& self) {
    return listed(self.samples_per_point_, self.pending_samples_, self.last_time_, self.pending_,
                  Growing{self.columns_});
  }
  bool is_sound() const { return pending_samples_ < samples_per_point_ && columns_[0].size() < max_points_; }

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
