#include "analysis/g2.h"

#include <algorithm>

#include "analysis/bins.h"
#include "analysis/geometry/pair_bins.h"
#include "analysis/geometry/periodic.h"
#include "base/core/check.h"

namespace shaken::analysis {
OrientationCorrelation::OrientationCorrelation(int bins, double r_max)
    : r_max_(r_max),
      pairs_(static_cast<std::size_t>(std::max(bins, 0))),
      sums_(pairs_.size()),
      expected_(pairs_.size()) {
  SHAKEN_CHECK(bins >= 1 && r_max > 0.0, "bins and range must not be empty");
}

void OrientationCorrelation::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors,
                                        const Region& region) {
  const Box& box = region.box();
  SHAKEN_CHECK(has_room(region, r_max_), "distances beyond half the box have no nearest image");
  const auto [xs, ys, cs, ss] = lying_rods(positions, directors, box.sides());
  const std::size_t n = xs.size();
  const std::size_t stride = reference_stride(n);
  const PairBins distances(pairs_.size(), r_max_, region);
  const auto too_far = static_cast<int>(pairs_.size());  // a bin of its own
  std::vector<int> bins(n);
  std::vector<double> values(n), sums(pairs_.size() + 1);
  std::vector<std::int64_t> pairs(pairs_.size() + 1);
  const double others = n > 0 ? static_cast<double>(n - 1) : 0.0;  // that a rod can make pairs with
  double references = 0;
  for (std::size_t i = static_cast<std::size_t>(calls_) % stride; i < n; i += stride) {
    references += 1;
    const double xi = xs[i], yi = ys[i], ci = cs[i], si = ss[i];
    distances.find(xi, yi, xs, ys, bins);
    for (std::size_t j = 0; j < n; ++j) values[j] = ci * cs[j] + si * ss[j];
    bins[i] = too_far;
    for (std::size_t j = 0; j < n; ++j) {
      const auto bin = static_cast<std::size_t>(bins[j]);
      ++pairs[bin];
      sums[bin] += values[j];
    }
    if (region.has_walls()) add_gas(expected_, r_max_, {xi, yi}, region, others / region.area());
  }
  // In a periodic box every place sees the same.
  if (!region.has_walls()) add_gas(expected_, r_max_, Vec2::Zero(), region, references * others / region.area());
  for (std::size_t bin = 0; bin < pairs_.size(); ++bin) {
    pairs_[bin] += pairs[bin];
    sums_[bin] += sums[bin];
  }
  ++calls_;
}

OrientationCurve OrientationCorrelation::reduce() const {
  const double width = r_max_ / static_cast<double>(pairs_.size());
  OrientationCurve curve;
  curve.r = middles_of_bins(pairs_.size(), width);
  for (std::size_t bin = 0; bin < pairs_.size(); ++bin) {
    curve.g2.push_back(mean_of(sums_[bin], pairs_[bin]));
    curve.g.push_back(mean_of(static_cast<double>(pairs_[bin]), expected_[bin]));
  }
  return curve;
}

}  // namespace shaken::analysis
