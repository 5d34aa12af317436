#include "analysis/rod_traces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/errors/steady.h"
#include "base/core/check.h"

namespace shaken::analysis {

RodTraces::RodTraces(int count, double duration)
    : count_(static_cast<std::size_t>(std::max(count, 0))), duration_(duration) {
  SHAKEN_CHECK(count >= 0 && duration >= 0.0, "some rods for some time");
}

void RodTraces::accumulate(double time, std::span<const Vec3> unwrapped, std::span<const Vec3> directors) {
  SHAKEN_CHECK(unwrapped.size() == directors.size(), "one position for each director");
  // The sample that is due at the end itself still belongs.
  if (!times_.empty() && !is_steady(times_.front() + duration_, time)) return;
  if (times_.empty()) traces_.resize(std::min(count_, unwrapped.size()));
  SHAKEN_CHECK(traces_.size() == std::min(count_, unwrapped.size()), "as many rods as before");
  times_.push_back(time);
  for (std::size_t k = 0; k < traces_.size(); ++k) {
    const std::size_t rod = k * unwrapped.size() / traces_.size();
    const Vec3& n = directors[rod];
    const bool upright = n.x() == 0.0 && n.y() == 0.0;
    traces_[k].x.push_back(unwrapped[rod].x());
    traces_[k].y.push_back(unwrapped[rod].y());
    traces_[k].theta.push_back(upright ? std::numeric_limits<double>::quiet_NaN() : std::atan2(n.y(), n.x()));
    traces_[k].n_z.push_back(n.z());
  }
}

}  // namespace shaken::analysis
