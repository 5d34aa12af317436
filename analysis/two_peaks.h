// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "analysis/angles.h"

namespace shaken::analysis {

/// Two mirrored Gaussians and a background under P(theta),
///   P = height (exp(-(theta - theta_m)^2 / 2 width^2) + exp(-(theta + theta_m)^2 / 2 width^2)) + background.
struct TwoPeaks {
  double theta_m = 0;     ///< [rad], in (0, pi/2)
  double width = 0;       ///< [rad]
  double height = 0;      ///< [1/rad]
  double background = 0;  ///< [1/rad]
  double dip = 0;         ///< P(0) / P(theta_m) of the fit, below 1
};

/// Least squares on the bins of `pdf` (Levenberg-Marquardt, from several starts). It is two peaks only where theta_m >
/// width, so that the curve has a minimum at 0, where a bin lies between them, and where the minimum is deeper than
/// four times its error as the residuals show it; otherwise, and of fewer than eight bins or no samples, there is none.
/// The dip of a shallow pair is filled up: theta_m is where the Gaussians stand, a little more than where P has its
/// maximum.
std::optional<TwoPeaks> find_two_peaks(const AnglePdf& pdf);

}  // namespace shaken::analysis
