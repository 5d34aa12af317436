#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// P(theta): bin centres and the probability density at them.
struct AnglePdf {
  std::vector<double> theta;    ///< (bins) bin centres in [-pi/2, pi/2) [rad]
  std::vector<double> density;  ///< (bins) [1/rad]; integral 1, or 0 everywhere without samples
};

/// Histogram of the in-plane angles of the rods, measured from the director of the same instant and folded into
/// [-pi/2, pi/2). Two peaks at +-theta_m are the mark of the layered phase. Rods exactly upright are left out.
class AngleDistribution : public Summed<AngleDistribution> {
 public:
  explicit AngleDistribution(int bins);

  void accumulate(std::span<const Vec3> directors);
  AnglePdf reduce() const;

  static constexpr const char* kName = "AngleDistribution";
  static auto fields(auto& self) { return listed(self.counts_); }

 private:
  std::vector<std::int64_t> counts_;
};

/// Two mirrored Gaussians and a background under P(theta),
///   P = height (exp(-(theta - theta_m)^2 / 2 width^2) + exp(-(theta + theta_m)^2 / 2 width^2)) + background,
/// and how far P itself dips between them.
struct TwoPeaks {
  double theta_m = 0;     ///< [rad], in [0, pi/2)
  double width = 0;       ///< [rad]
  double height = 0;      ///< [1/rad]
  double background = 0;  ///< [1/rad]
  /// P(0) / max P of the samples, both hands taken together, each averaged over width / 2: below 1 if there are two
  /// peaks, but for noise; 1 if there is one.
  double dip = 0;
  /// Where P itself is highest, both hands taken together [rad], in [0, pi/2]: what one reads off the curve. The
  /// maximum of a cubic fitted about it, weighted by a Gaussian of standard deviation width / 2 (two bins at least, pi
  /// / 8 at most). Of overlapping peaks it lies below theta_m. The fit's own bias is inwards, 0.004 widths where
  /// theta_m is 1.5 widths, 0.03 where it is 1.25, and 0.11 where it is 1.1 and there is hardly a dip. NaN where there
  /// is none.
  double maximum = 0;
};

/// Least squares on the bins of `pdf` (Levenberg-Marquardt, from several starts). One broad peak is fitted as well; it
/// is the dip that tells. That of a shallow pair is filled up: theta_m is where the Gaussians stand, a little more than
/// `maximum`, where P is highest. Nothing of fewer than eight bins or no samples.
std::optional<TwoPeaks> fit_two_peaks(const AnglePdf& pdf);

/// Whether a dip shows two peaks: deeper than twice its error, which samples from different times tell. Not if the
/// error is unknown.
bool are_two(const Estimate& dip);

}  // namespace shaken::analysis
