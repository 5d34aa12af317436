#include "analysis/drift.h"

namespace shaken::analysis {

void Drift::accumulate(double time, std::span<const Vec3> unwrapped) {
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

}  // namespace shaken::analysis
