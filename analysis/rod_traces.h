#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "analysis/errors/saved.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// The way of one rod; all of shape (samples).
struct RodTrace {
  std::vector<double> x, y;   ///< unwrapped centre [mm]
  std::vector<double> theta;  ///< in-plane angle of the director with its label, in (-pi, pi] [rad]; NaN if upright
  std::vector<double> n_z;    ///< vertical component of the director
  static auto fields(auto& self) { return listed(Growing{self.x, self.y, self.theta, self.n_z}); }
};

/// Where some rods go, sample by sample, from the first one on for a given time and no longer: 32 bytes a sample and
/// rod. Of n_rods rods, numbers k n_rods / count are kept, k = 0 .. count - 1; all if there are not more.
class RodTraces : public Saved<RodTraces> {
 public:
  /// `count` rods for `duration` [s].
  RodTraces(int count, double duration);

  /// At `time` [s]: unwrapped centres (n_rods) [mm] and directors (n_rods); n_rods is the same in every call.
  void accumulate(double time, std::span<const Vec3> unwrapped, std::span<const Vec3> directors);
  const std::vector<double>& times() const { return times_; }      ///< (samples) [s]
  const std::vector<RodTrace>& traces() const { return traces_; }  ///< (rods kept)

  static constexpr const char* kName = "RodTraces";
  static auto fields(auto& self) {
    return listed(Setting{"duration", self.duration_}, Setting{"number of rods", self.count_}, Growing{self.times_},
                  Length{self.traces_}, self.traces_);
  }
  bool is_sound() const {
    return traces_.size() <= count_ &&
           std::ranges::all_of(traces_, [&](const RodTrace& trace) { return trace.x.size() == times_.size(); });
  }

 private:
  std::size_t count_;
  double duration_;
  std::vector<double> times_;
  std::vector<RodTrace> traces_;
};

}  // namespace shaken::analysis
