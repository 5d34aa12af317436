// SPDX-License-Identifier: MIT
#include "analysis/two_peaks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unsupported/Eigen/NonLinearOptimization>
#include <vector>

#include "analysis/fold.h"

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

}  // namespace

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
  return peaks;
}

bool are_two(const Estimate& dip) { return dip.value + 2 * dip.sem < 1; }

}  // namespace shaken::analysis
