#include "analysis/density_maps.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/bins.h"
#include "analysis/errors/parts.h"
#include "analysis/errors/steady.h"
#include "analysis/errors/summed.h"
#include "analysis/geometry/periodic.h"
#include "analysis/lags/lag_fits.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Places in a cell at which it is asked whether it lies within walls, each way.
constexpr int kPlacesInCell = 32;
/// Lags of the correlation, at most.
constexpr std::size_t kMostLags = 512;

/// The share of each cell that lies within walls, 0 to 1 (rows * columns).
std::vector<double> shares_within(const Region& region, const Grid& grid) {
  if (!region.has_walls()) return std::vector<double>(grid.nodes(), 1.0);
  const Vec2 mesh(region.box().x() / grid.columns, region.box().y() / grid.rows);
  std::vector<double> shares;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      int within = 0;
      for (int b = 0; b < kPlacesInCell; ++b) {
        for (int a = 0; a < kPlacesInCell; ++a) {
          const Vec2 place = Vec2(i, j) + Vec2(a + 0.5, b + 0.5) / kPlacesInCell;
          within += region.contains(mesh.cwiseProduct(place)) ? 1 : 0;
        }
      }
      shares.push_back(static_cast<double>(within) / (kPlacesInCell * kPlacesInCell));
    }
  }
  return shares;
}

}  // namespace

DensityMaps::DensityMaps(const Region& region, const Grid& grid, double interval, std::int64_t samples_per_map)
    : grid_(grid),
      region_(region),
      interval_(interval),
      samples_per_map_(samples_per_map),
      share_(shares_within(region, grid)),
      counts_(grid.nodes()) {
  SHAKEN_CHECK(interval > 0 && samples_per_map >= 1, "a map takes some time");
  const double cell = region.box().area() / static_cast<double>(grid.nodes());
  for (double& share : share_) {
    if (share < kLeastShare) share = 0;
    area_.push_back(share * cell);
  }
  const double all = std::accumulate(share_.begin(), share_.end(), 0.0);
  for (double& share : share_) share /= all;
}

void DensityMaps::accumulate(double time, std::span<const Vec3> positions) {
  const Box& box = region_.box();
  const auto cell_of = [](double place, double side, int n) {
    return static_cast<std::size_t>(std::min(n - 1, static_cast<int>(wrapped(place, side) / side * n)));
  };
  for (const Vec3& at : positions) {
    ++counts_[cell_of(at.y(), box.y(), grid_.rows) * static_cast<std::size_t>(grid_.columns) +
              cell_of(at.x(), box.x(), grid_.columns)];
  }
  time_ += time;
  if (++samples_ < samples_per_map_) return;
  times_.push_back(time_ / static_cast<double>(samples_));
  const double mean = static_cast<double>(positions.size()) / region_.area();
  for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
    const double count = static_cast<double>(counts_[cell]) / static_cast<double>(samples_);
    densities_.push_back(mean_of(count, area_[cell]) / mean);
  }
  counts_.assign(counts_.size(), 0);
  samples_ = 0;
  time_ = 0;
}

double DensityMaps::product(std::size_t a, std::size_t b) const {
  const double *first = &densities_[a * counts_.size()], *second = &densities_[b * counts_.size()];
  double sum = 0;
  for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
    if (share_[cell] > 0) sum += share_[cell] * (first[cell] - 1) * (second[cell] - 1);
  }
  return sum;
}

DensitySummary DensityMaps::reduce(double t_steady) const {
  const double half = 0.5 * static_cast<double>(samples_per_map_ - 1) * interval_;
  std::size_t first = 0;
  while (first < times_.size() && !is_steady(times_[first] - half, t_steady)) ++first;
  const std::size_t n = times_.size() - first, cells = counts_.size();
  DensitySummary summary;
  summary.mean.assign(cells, kNaN);
  if (n == 0) return summary;
  summary.variance_of_mean.value = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (share_[cell] == 0) continue;
    double sum = 0;
    for (std::size_t k = first; k < times_.size(); ++k) sum += densities_[k * cells + cell];
    summary.mean[cell] = sum / static_cast<double>(n);
    summary.variance_of_mean.value += share_[cell] * (summary.mean[cell] - 1) * (summary.mean[cell] - 1);
  }
  std::vector<double> squares;
  for (std::size_t k = first; k < times_.size(); ++k) squares.push_back(product(k, k));
  const double square = mean_of(squares);
  summary.variance = estimate_from_parts(square, parts_of_series(squares));
  for (std::size_t lag = 0; lag < std::min(kMostLags, (n + 3) / 4); ++lag) {
    std::vector<double> products;
    for (std::size_t k = 0; k + lag < n; ++k) products.push_back(product(first + k, first + k + lag));
    const double correlation = mean_of(products) / square;
    // of the ratio, to first order
    for (std::size_t k = 0; k < products.size(); ++k) products[k] = (products[k] - correlation * squares[k]) / square;
    summary.lag.push_back(static_cast<double>(lag) * static_cast<double>(samples_per_map_) * interval_);
    summary.correlation.push_back(estimate_from_parts(correlation, parts_of_series(products)));
  }
  summary.correlation_time = decay_time(summary.lag, summary.correlation);
  return summary;
}

}  // namespace shaken::analysis
