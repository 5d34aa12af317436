#include "analysis/defect_series.h"

#include "analysis/errors/steady.h"
#include "base/core/check.h"

namespace shaken::analysis {

void DefectSeries::accumulate(double time, std::span<const Defect> defects, std::span<const std::int64_t> tracks) {
  SHAKEN_CHECK(defects.size() == tracks.size(), "one track for each defect");
  double n_plus = 0, n_minus = 0;
  for (const Defect& defect : defects) (defect.charge > 0 ? n_plus : n_minus) += 1;
  counts_.accumulate(time, {n_plus, n_minus});
  if (!keeps_list_) return;
  for (std::size_t i = 0; i < defects.size(); ++i) {
    list_.time.push_back(time);
    list_.x.push_back(defects[i].position.x());
    list_.y.push_back(defects[i].position.y());
    list_.charge.push_back(defects[i].charge);
    list_.direction.push_back(defects[i].direction);
    list_.track.push_back(static_cast<double>(tracks[i]));
  }
}

DefectSeries::MeanCounts DefectSeries::reduce(double t_steady) const {
  MeanCounts mean;
  double points = 0;
  for (std::size_t i = 0; i < times().size(); ++i) {
    if (!is_steady(times()[i], t_steady)) continue;
    mean.n_plus += n_plus()[i];
    mean.n_minus += n_minus()[i];
    points += 1;
  }
  if (points > 0) {
    mean.n_plus /= points;
    mean.n_minus /= points;
  }
  return mean;
}

}  // namespace shaken::analysis
