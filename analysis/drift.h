#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/bounded_series.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Displacements and the time that they took, summed.
class DriftStatistics : public Summed<DriftStatistics> {
 public:
  /// A displacement in the plane [mm] within so much time [s].
  void accumulate(const Vec2& displacement, double time) {
    x_ += displacement.x();
    y_ += displacement.y();
    time_ += time;
  }
  /// Mean velocity [mm/s]; NaN without time.
  Vec2 reduce() const { return Vec2(x_, y_) / time_; }

  static constexpr const char* kName = "DriftStatistics";
  static auto fields(auto& self) { return listed(self.x_, self.y_, self.time_); }

 private:
  double x_ = 0, y_ = 0, time_ = 0;
};

/// Where rods drift together: the displacement in the plane of the mean of their centres since the first sample. It is
/// followed through the periodic border, so the mean velocity between two samples is exact, whatever rods do between
/// them, and none of the vibration is left in it after a whole number of periods.
class Drift : public Saved<Drift> {
 public:
  /// At `time` [s], later than all before: unwrapped centres (n_rods) [mm], the same rods in every call.
  void accumulate(double time, std::span<const Vec3> unwrapped) {
    Vec2 centre = Vec2::Zero();
    for (const Vec3& place : unwrapped) centre += place.head<2>();
    centre /= static_cast<double>(unwrapped.size());
    if (!has_first_) first_ = centre;
    series_.accumulate(time, {centre.x() - first_.x(), centre.y() - first_.y()});
    if (has_first_) statistics_.accumulate(last_time_, Vec2(centre - last_), time - last_time_);
    has_first_ = true;
    last_ = centre;
    last_time_ = time;
  }

  const std::vector<double>& times() const { return series_.times(); }  ///< (n) [s]
  const std::vector<double>& x() const { return series_.column(0); }    ///< (n) displacement [mm]
  const std::vector<double>& y() const { return series_.column(1); }    ///< (n) [mm]
  const Blocked<DriftStatistics>& statistics() const { return statistics_; }

  static constexpr const char* kName = "Drift";
  static auto fields(auto& self) {
    return listed(self.has_first_, self.first_, self.last_, self.last_time_, self.series_, self.statistics_);
  }

 private:
  bool has_first_ = false;
  Vec2 first_ = Vec2::Zero(), last_ = Vec2::Zero();  // mean centre at the first and the last sample [mm]
  double last_time_ = 0;
  BoundedSeries<2> series_;
  Blocked<DriftStatistics> statistics_{DriftStatistics()};
};

}  // namespace shaken::analysis
