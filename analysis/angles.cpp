#include "analysis/angles.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <unsupported/Eigen/NonLinearOptimization>
#include <vector>

#include "analysis/bins.h"
#include "analysis/geometry/periodic.h"
#include "analysis/order.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// Residuals of the bins and their derivatives; parameters theta_m, width, height, background.
struct Residuals {
  const AnglePdf& pdf;

  int values() const { return static_cast<int>(pdf.theta.size()); }
  int operator()(const Eigen::VectorXd& p, Eigen::VectorXd& residuals) const {
    for (int i = 0; i < values(); ++i) {
      const double theta = pdf.theta[static_cast<std::size_t>(i)];
      const double right = fold_half_turn(theta - p[0]) / p[1], left = fold_half_turn(theta + p[0]) / p[1];
      const double model = p[2] * (std::exp(-right * right / 2) + std::exp(-left * left / 2)) + p[3];
      residuals[i] = model - pdf.density[static_cast<std::size_t>(i)];
    }
    return 0;
  }
  int df(const Eigen::VectorXd& p, Eigen::MatrixXd& jacobian) const {
    for (int i = 0; i < values(); ++i) {
      const double theta = pdf.theta[static_cast<std::size_t>(i)];
      const double right = fold_half_turn(theta - p[0]) / p[1], left = fold_half_turn(theta + p[0]) / p[1];
      const double at_right = std::exp(-right * right / 2), at_left = std::exp(-left * left / 2);
      jacobian(i, 0) = p[2] / p[1] * (right * at_right - left * at_left);
      jacobian(i, 1) = p[2] / p[1] * (right * right * at_right + left * left * at_left);
      jacobian(i, 2) = at_right + at_left;
      jacobian(i, 3) = 1;
    }
    return 0;
  }
};

/// P(0) / max P, of P(theta) and P(-theta) together, averaged over `half` [rad] and at least one bin to either side.
double dip_of(const AnglePdf& pdf, double half) {
  const std::size_t bins = pdf.density.size();
  const auto reach = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::lround(half * static_cast<double>(bins) / kPi)), 1, bins / 2);
  const std::size_t about_zero = bins / 2 - reach, length = (bins - 1) / 2 + reach + 1 - about_zero;
  const auto sum_from = [&](std::size_t first) {
    double sum = 0;
    for (std::size_t k = first; k < first + length; ++k) {
      sum += pdf.density[k % bins] + pdf.density[bins - 1 - k % bins];
    }
    return sum;
  };
  double highest = 0;
  for (std::size_t first = 0; first < bins; ++first) highest = std::max(highest, sum_from(first));
  return sum_from(about_zero) / highest;
}

/// Where P(theta) + P(-theta) is highest, from `start` on: the maximum of the cubic fitted to it with a Gaussian of
/// standard deviation `reach` about that maximum as weight, again until it stays (local polynomial regression: Fan &
/// Gijbels 1996). NaN where the cubic has none.
double maximum_of(const AnglePdf& pdf, double start, double reach) {
  const auto bins = static_cast<Eigen::Index>(pdf.density.size());
  Eigen::MatrixXd powers(bins, 4);
  Eigen::VectorXd both(bins);
  double place = start;
  for (int step = 0; step < 100; ++step) {
    for (Eigen::Index k = 0; k < bins; ++k) {
      const auto bin = static_cast<std::size_t>(k);
      const double x = fold_half_turn(pdf.theta[bin] - place) / reach;
      const double root_of_weight = std::exp(-x * x / 4);
      powers.row(k) << root_of_weight, root_of_weight * x, root_of_weight * x * x, root_of_weight * x * x * x;
      both[k] = root_of_weight * (pdf.density[bin] + pdf.density[pdf.density.size() - 1 - bin]);
    }
    const Eigen::VectorXd c = powers.colPivHouseholderQr().solve(both);
    const double discriminant = c[2] * c[2] - 3 * c[1] * c[3];
    if (!(discriminant >= 0)) return std::numeric_limits<double>::quiet_NaN();
    const double shift = std::clamp(c[1] / (std::sqrt(discriminant) - c[2]), -1.0, 1.0);
    place += shift * reach;
    if (std::abs(shift) < 1e-9) break;
  }
  return std::abs(fold_half_turn(place));
}

/// The maximum of the two Gaussians alone: x = theta_m tanh(x theta_m / width^2).
double maximum_of_model(double theta_m, double width) {
  double x = theta_m;
  for (int step = 0; step < 200; ++step) x = theta_m * std::tanh(x * theta_m / (width * width));
  return x;
}

}  // namespace

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

std::optional<TwoPeaks> fit_two_peaks(const AnglePdf& pdf) {
  const std::size_t bins = pdf.theta.size();
  if (bins < 8) return std::nullopt;
  const double highest = *std::max_element(pdf.density.begin(), pdf.density.end());
  if (!(highest > 0)) return std::nullopt;
  double squares = 0;
  for (std::size_t i = 0; i < bins; ++i) squares += pdf.density[i] * pdf.theta[i] * pdf.theta[i];
  const double spread = std::sqrt(squares * kPi / static_cast<double>(bins));

  // A mixture of spread^2 = theta_m^2 + width^2 may be anything from one broad peak to two narrow ones.
  const Residuals residuals{pdf};
  Eigen::VectorXd best;
  double best_norm = 0;
  for (const double share : {0.3, 0.6, 0.8, 0.95}) {
    Eigen::VectorXd p(4);
    p << share * spread, spread * std::sqrt(1 - share * share), highest / 2, 0;
    Eigen::LevenbergMarquardt<const Residuals> solver(residuals);
    const auto status = solver.minimize(p);
    if (status == Eigen::LevenbergMarquardtSpace::ImproperInputParameters || !p.allFinite()) continue;
    if (best.size() == 0 || solver.fnorm < best_norm) {
      best = p;
      best_norm = solver.fnorm;
    }
  }
  if (best.size() == 0) return std::nullopt;

  TwoPeaks peaks;
  peaks.theta_m = std::abs(best[0]);
  peaks.width = std::abs(best[1]);
  peaks.height = best[2];
  peaks.background = best[3];
  peaks.dip = dip_of(pdf, peaks.width / 4);
  const double bin = kPi / static_cast<double>(bins);
  peaks.maximum =
      maximum_of(pdf, maximum_of_model(peaks.theta_m, peaks.width), std::clamp(peaks.width / 2, 2 * bin, kPi / 8));
  return peaks;
}

bool are_two(const Estimate& dip) { return dip.value + 2 * dip.sem < 1; }

}  // namespace shaken::analysis
