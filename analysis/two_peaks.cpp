// SPDX-License-Identifier: MIT
#include "analysis/two_peaks.h"

#include <algorithm>
#include <cmath>
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

}  // namespace

std::optional<TwoPeaks> find_two_peaks(const AnglePdf& pdf) {
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
  const double bin = kPi / static_cast<double>(bins);
  const double ratio = peaks.theta_m / peaks.width;
  const double at_centre = 2 * peaks.height * std::exp(-ratio * ratio / 2) + peaks.background;
  const double at_peak = peaks.height * (1 + std::exp(-2 * ratio * ratio)) + peaks.background;
  peaks.dip = at_centre / at_peak;
  // Residuals grow with the density: those that count are where the rods are. The fit averages about width / bin bins.
  Eigen::VectorXd residual(static_cast<Eigen::Index>(bins));
  residuals(best, residual);
  double weight = 0, weighted_squares = 0;
  for (std::size_t i = 0; i < bins; ++i) {
    weight += pdf.density[i];
    weighted_squares +=
        pdf.density[i] * residual[static_cast<Eigen::Index>(i)] * residual[static_cast<Eigen::Index>(i)];
  }
  const double error = std::sqrt(weighted_squares / weight * std::min(1.0, bin / peaks.width));
  const bool two = peaks.height > 0 && peaks.theta_m > peaks.width && peaks.theta_m > 1.5 * bin &&
                   peaks.theta_m < kPi / 2 && peaks.dip < 1 && at_peak - at_centre > 4 * error;
  return two ? std::optional(peaks) : std::nullopt;
}

}  // namespace shaken::analysis
