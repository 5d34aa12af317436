#include "analysis/oscillation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// In standard deviations: what some tens of independent points rise and fall by themselves.
constexpr double kProminence = 6;

/// Standard deviation of single points about a smooth curve: differences of neighbours, in the farther half of it.
double noise(const std::vector<double>& values) {
  double squares = 0;
  std::size_t n = 0;
  for (std::size_t i = values.size() / 2; i + 1 < values.size(); ++i) {
    squares += (values[i + 1] - values[i]) * (values[i + 1] - values[i]) / 2;
    ++n;
  }
  return n > 0 ? std::sqrt(squares / static_cast<double>(n)) : 0.0;
}

}  // namespace

std::optional<double> first_period(std::span<const double> r, std::span<const double> values, double smoothing) {
  SHAKEN_CHECK(r.size() == values.size(), "one value for each distance");
  std::vector<double> x, y;
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    x.push_back(r[i]);
    y.push_back(values[i]);
  }
  if (x.size() < 5) return std::nullopt;
  const double spacing = r[1] - r[0];
  const auto window = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(smoothing / spacing)));
  if (x.size() < window + 4) return std::nullopt;
  std::vector<double> centre, smooth;
  for (std::size_t i = 0; i + window <= x.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < window; ++k) sum += y[i + k];
    centre.push_back((x[i] + x[i + window - 1]) / 2);
    smooth.push_back(sum / static_cast<double>(window));
  }
  const double prominence = std::max(kProminence * noise(y) / std::sqrt(static_cast<double>(window)), 1e-9);

  // Down from the first maximum, up from the minimum, down from the maximum that is looked for.
  std::size_t i = 0, lowest = 0, highest = 0;
  const auto leave_maximum = [&] {
    for (highest = i; i < smooth.size() && smooth[i] >= smooth[highest] - prominence; ++i) {
      if (smooth[i] > smooth[highest]) highest = i;
    }
  };
  leave_maximum();
  do {
    for (lowest = i; i < smooth.size() && smooth[i] <= smooth[lowest] + prominence; ++i) {
      if (smooth[i] < smooth[lowest]) lowest = i;
    }
    leave_maximum();
    if (i >= smooth.size()) return std::nullopt;
  } while (centre[highest] < 2 * smoothing);

  const double floor = smooth[highest] - 0.3 * (smooth[highest] - smooth[lowest]);
  std::size_t first = highest, last = highest;
  while (first > 0 && smooth[first - 1] > floor) --first;
  while (last + 1 < smooth.size() && smooth[last + 1] > floor) ++last;
  // about the maximum evenly, so that a curve that is no parabola does not draw it aside
  const std::size_t reach = std::min(highest - first, last - highest);
  if (reach == 0) return centre[highest];
  const auto points = static_cast<Eigen::Index>(2 * reach + 1);
  Eigen::MatrixXd powers(points, 3);
  Eigen::VectorXd heights(points);
  for (Eigen::Index k = 0; k < points; ++k) {
    const std::size_t point = highest - reach + static_cast<std::size_t>(k);
    const double d = (centre[point] - centre[highest]) / spacing;
    powers.row(k) << 1, d, d * d;
    heights[k] = smooth[point];
  }
  const Eigen::VectorXd fit = powers.colPivHouseholderQr().solve(heights);
  const double top = -fit[1] / (2 * fit[2]);
  if (!(fit[2] < 0) || std::abs(top) > static_cast<double>(reach)) return centre[highest];
  return centre[highest] + top * spacing;
}

}  // namespace shaken::analysis
