#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/saved.h"
#include "analysis/lags/lag_average.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Wave numbers of SelfScattering, each twice the one before.
inline constexpr std::size_t kScatteringWaves = 4;

/// Phases that rods gain between two samples.
struct ScatteringKernel {
  static constexpr std::string_view kName = "SelfScattering";
  static constexpr std::size_t kColumns = 2;  // q x and q y of the unwrapped centre, q being the smallest [rad]
  /// With a and b the phases gained along and across the director at the origin time: cos 2^k a of all waves k, cos 2^k
  /// b of all, and a^2, b^2, a^4, b^4, a^2 b^2.
  static constexpr std::size_t kQuantities = 2 * kScatteringWaves + 5;
  static constexpr bool kLagZero = false;
  static LagPair<kQuantities> between(const LagFrame<kColumns>& origin, const LagFrame<kColumns>& later);
};

/// Self-intermediate scattering against lag; all of shape (lags met so far).
struct ScatteringCurve {
  std::vector<double> lag;  ///< [s], rising
  /// By wave: of q along the director at the origin time, across it, and the mean of both. 1 at lag 0.
  std::array<EstimateCurve, kScatteringWaves> along, across, mean;
  EstimateCurve alpha_2;         ///< <r^4> / (2 <r^2>^2) - 1 of displacements r in the plane
  EstimateCurve alpha_2_along;   ///< <x^4> / (3 <x^2>^2) - 1 of those along the director
  EstimateCurve alpha_2_across;  ///< of those across it
};

struct ScatteringSummary {
  /// By wave: lag at which the mean of both directions falls to 1/e (see decay_time) [s]; NaN if it does not.
  std::array<Estimate, kScatteringWaves> relaxation;
  /// The largest alpha_2 among the lags that have an error; NaN without such. Being the largest of several numbers, it
  /// lies above the truth by about an error where alpha_2 is level.
  Estimate alpha_2_peak;
  double alpha_2_peak_lag = std::numeric_limits<double>::quiet_NaN();  ///< [s]
};

/// Self-intermediate scattering function F_s(q, t) = <cos q . (r(t0 + t) - r(t0))> (Hansen & McDonald, Theory of Simple
/// Liquids, section 7.4) and non-Gaussian parameter alpha_2(t) (Rahman, Phys. Rev. 136, A405 (1964)) in the plane,
/// while the run goes on, at the lags of LagAverage and in 128 bytes per level and rod. Of free diffusion along the
/// director F_s = exp(-q^2 D t) and alpha_2_along = 0. Gaussian displacements with mean squares s and s' along and
/// across have alpha_2 = (s - s')^2 / (2 (s + s')^2).
class SelfScattering : public Saved<SelfScattering> {
 public:
  /// `interval`: time between successive accumulate calls [s]; `wavelength`: 2 pi / q of the smallest q [mm].
  SelfScattering(double interval, double wavelength, int n_levels = 16);

  /// (waves) rising [rad/mm]
  std::vector<double> wave_numbers() const;
  /// At `time` [s]: unwrapped centres (n_rods) [mm], and the angle of the nematic director [rad]; n_rods is the same in
  /// every call.
  void accumulate(double time, std::span<const Vec3> unwrapped, double director);
  /// Averages over the origins from `t_steady` [s] on.
  ScatteringCurve reduce(double t_steady = -std::numeric_limits<double>::max()) const;
  static ScatteringSummary summarize(const ScatteringCurve& curve);

  static auto fields(auto& self) { return listed(Setting{"wavelength", self.smallest_}, self.average_); }

 private:
  double smallest_;  // q [rad/mm]
  LagAverage<ScatteringKernel> average_;
};

}  // namespace shaken::analysis
