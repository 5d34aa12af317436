#include "analysis/angles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/bins.h"
#include "analysis/geometry/periodic.h"
#include "analysis/order.h"
#include "base/core/check.h"

namespace shaken::analysis {

AngleDistribution::AngleDistribution(int bins) : counts_(static_cast<std::size_t>(std::max(bins, 0))) {
  SHAKEN_CHECK(bins >= 1, "a histogram needs a bin");
}

void AngleDistribution::accumulate(std::span<const Vec3> directors) {
  const double mean_axis = nematic_order(directors).director;
  const double bins_per_radian = static_cast<double>(counts_.size()) / kPi;
  for (const Vec3& director : directors) {
    if (director.x() == 0.0 && director.y() == 0.0) continue;
    const double theta = fold_half_turn(std::atan2(director.y(), director.x()) - mean_axis);
    const auto bin = static_cast<std::size_t>((theta + kPi / 2) * bins_per_radian);
    ++counts_[std::min(bin, counts_.size() - 1)];  // rounding may reach the end just below pi/2
  }
}

AnglePdf AngleDistribution::reduce() const {
  const std::size_t bins = counts_.size();
  const double width = kPi / static_cast<double>(bins);
  const auto total = static_cast<double>(std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0}));
  AnglePdf pdf{middles_of_bins(bins, width, -kPi / 2), std::vector<double>(bins)};
  for (std::size_t i = 0; total > 0 && i < bins; ++i)
    pdf.density[i] = static_cast<double>(counts_[i]) / (total * width);
  return pdf;
}

}  // namespace shaken::analysis
