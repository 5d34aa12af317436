// SPDX-License-Identifier: MIT
#include "analysis/defect_series.h"

#include <utility>

#include "analysis/steady.h"
#include "sim/core/check.h"

namespace shaken::analysis {

void DefectSeries::accumulate(double time, std::span<const Defect> defects) {
  SHAKEN_CHECK(times_.empty() || time > times_.back(), "samples must come in order of time");
  double n_plus = 0, n_minus = 0;
  for (const Defect& defect : defects) {
    (defect.charge > 0 ? n_plus : n_minus) += 1;
    list_.time.push_back(time);
    list_.x.push_back(defect.position.x());
    list_.y.push_back(defect.position.y());
    list_.charge.push_back(defect.charge);
    list_.direction.push_back(defect.direction);
  }
  times_.push_back(time);
  n_plus_.push_back(n_plus);
  n_minus_.push_back(n_minus);
}

DefectSeries::MeanCounts DefectSeries::reduce(double t_steady) const {
  MeanCounts mean;
  double samples = 0;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (!is_steady(times_[i], t_steady)) continue;
    mean.n_plus += n_plus_[i];
    mean.n_minus += n_minus_[i];
    samples += 1;
  }
  if (samples > 0) {
    mean.n_plus /= samples;
    mean.n_minus /= samples;
  }
  return mean;
}

void DefectSeries::reset() { *this = {}; }

void DefectSeries::save(StateWriter& writer) const {
  writer.tag("DefectSeries");
  for (const auto* array :
       {&times_, &n_plus_, &n_minus_, &list_.time, &list_.x, &list_.y, &list_.charge, &list_.direction}) {
    writer.put(*array);
  }
}

void DefectSeries::restore(StateReader& reader) {
  reader.tag("DefectSeries");
  DefectSeries saved;
  saved.times_ = reader.reals();
  const std::size_t n_samples = saved.times_.size();
  saved.n_plus_ = reader.reals(n_samples);
  saved.n_minus_ = reader.reals(n_samples);
  saved.list_.time = reader.reals();
  const std::size_t n_defects = saved.list_.time.size();
  saved.list_.x = reader.reals(n_defects);
  saved.list_.y = reader.reals(n_defects);
  saved.list_.charge = reader.reals(n_defects);
  saved.list_.direction = reader.reals(n_defects);
  *this = std::move(saved);
}

}  // namespace shaken::analysis
