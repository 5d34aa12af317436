#include "analysis/tilt.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/bins.h"
#include "analysis/errors/jackknife.h"
#include "base/core/check.h"

namespace shaken::analysis {

TiltVelocity::TiltVelocity(int bins, double n_z_max) : n_z_max_(n_z_max) {
  SHAKEN_CHECK(bins >= 1, "a histogram needs a bin");
  SHAKEN_CHECK(n_z_max > 0.0, "the range of n_z must not be empty");
  const auto n = static_cast<std::size_t>(bins);
  counts_.resize(n);
  along_.resize(n);
  across_.resize(n);
}

void TiltVelocity::accumulate(std::span<const Vec3> directors, std::span<const Vec3> velocities) {
  SHAKEN_CHECK(directors.size() == velocities.size(), "one velocity for each director");
  const double bins_per_unit = static_cast<double>(counts_.size()) / (2.0 * n_z_max_);
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec3& n = directors[i];
    const Vec3& v = velocities[i];
    const double n_xy = std::hypot(n.x(), n.y());
    if (n_xy == 0.0) continue;
    if (std::abs(n.z()) > n_z_max_) {
      ++outside_;
      continue;
    }
    const auto place = static_cast<std::size_t>((n.z() + n_z_max_) * bins_per_unit);
    const std::size_t bin = std::min(place, counts_.size() - 1);  // n_z_max itself belongs to the last bin
    ++counts_[bin];
    along_[bin] += (v.x() * n.x() + v.y() * n.y()) / n_xy;
    across_[bin] += (v.y() * n.x() - v.x() * n.y()) / n_xy;
  }
}

TiltMeans TiltVelocity::means() const {
  double total = static_cast<double>(outside_);
  for (const std::int64_t count : counts_) total += static_cast<double>(count);
  const double width = 2.0 * n_z_max_ / static_cast<double>(counts_.size());
  TiltMeans means;
  means.n_z = middles_of_bins(counts_.size(), width, -n_z_max_);
  for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
    const auto n = static_cast<double>(counts_[bin]);
    means.v_along.push_back(mean_of(along_[bin], n));
    means.v_across.push_back(mean_of(across_[bin], n));
    means.density.push_back(total > 0 ? n / (total * width) : 0.0);
  }
  return means;
}

TiltCurve TiltVelocity::reduce(const TiltVelocity& empty, const std::vector<TiltVelocity>& blocks) {
  TiltVelocity all = empty;
  for (const TiltVelocity& block : blocks) all.merge(block);
  const std::vector<Estimate> estimates = jackknife(empty, blocks, [](const TiltVelocity& part) {
    TiltMeans means = part.means();
    means.v_along.insert(means.v_along.end(), means.v_across.begin(), means.v_across.end());
    return means.v_along;
  });
  TiltCurve curve{all.means(), {}, {}};
  const std::vector<std::size_t> met = blocks_met(blocks);
  const std::size_t bins = curve.n_z.size();
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const bool known = !met.empty() && met[bin] >= kFewestParts;
    curve.v_along_sem.push_back(known ? estimates[bin].sem : kNaN);
    curve.v_across_sem.push_back(known ? estimates[bins + bin].sem : kNaN);
  }
  return curve;
}

std::vector<std::size_t> blocks_met(const std::vector<TiltVelocity>& blocks) {
  std::vector<std::size_t> met;
  for (const TiltVelocity& block : blocks) {
    const std::vector<double> density = block.means().density;
    met.resize(density.size());
    for (std::size_t bin = 0; bin < met.size(); ++bin) met[bin] += density[bin] > 0 ? 1 : 0;
  }
  return met;
}

}  // namespace shaken::analysis
