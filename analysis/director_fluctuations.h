#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/jackknife.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Fluctuations of the director against the wave vector, and the elastic constants that they tell of.
struct DirectorSpectrum {
  /// Means over squares of side 2 pi / L of the quadrant |q_along|, |q_across| that any wave vector fell into; all of
  /// the same length.
  std::vector<double> q_along, q_across;  ///< [1/mm]
  std::vector<Estimate> power;            ///< L^2 <|dtheta_q|^2> without the floor of uncorrelated rods [mm^2]
  std::vector<double> fit;                ///< what the fit makes of it [mm^2]
  double floor = 0;                       ///< what was taken off [mm^2]; NaN without samples

  Estimate splay, bend;  ///< K1 and K3 in units of the effective temperature
  Estimate ratio;        ///< K3 / K1
  /// chi^2 per degree of freedom over the squares of the fit, from their own errors: about 1 where the law holds.
  double chi2 = 0;
  std::int64_t samples = 0;  ///< that had a director
};

/// The director's fluctuations in q-space, of rods in a periodic square box that are ordered: with the director at
/// angle theta_N, S the order and n rods,
///   dtheta_q = (1 / n) sum_i sin 2 (theta_i - theta_N) / (2 S) exp(-i q . r_i),   q = 2 pi (m, n) / L, |m|, |n| <= 6.
/// Dividing by S makes it linear in the director's angle whatever the rods' own noise. A nematic of splay constant K1
/// and bend constant K3 in two dimensions has (de Gennes & Prost, The Physics of Liquid Crystals, section 3.4)
///   L^2 <|dtheta_q|^2> = 1 / (K1 q_across^2 + K3 q_along^2),
/// K in units of the temperature. Shaken rods have none: their K are effective, and only the ratio and the law itself
/// can be held against theory.
///
/// Floor: let s be the summand, s = f + e, f of waves and e each rod's own. At every q, e adds L^2 <e^2> / n; and a
/// wave of wave vector k and power |f_k|^2 adds L^2 |f_k|^2 S(q - k) / n, with the structure factor S of the rods'
/// places: as much again as noise if they stand at random, nothing if they are spaced evenly. So, with S_0 the mean of
/// S over the measured waves,
///   n floor = L^2 ((1 - S_0) <e^2> + S_0 <s^2>).
/// What rods do not share with the rod nearest to them, after the measured waves' part of that, is their own:
///   <e^2> = <s^2> - <s s'> - sum_q (P_q - floor) / L^2 (1 - <cos q . (r - r')>),   ' of the nearest.
/// Without the last two, rods side by side that lean together count as noise, and the short waves come out negative.
/// With fewer than 336 rods, S_0 = 1.
///
/// The director may wander: samples are summed in sectors of 5 degrees of its angle, and every sector has its own
/// wave vectors along and across.
class DirectorFluctuations : public Saved<DirectorFluctuations> {
 public:
  /// Samples with less order have no director to speak of and are left out.
  static constexpr double kMinOrder = 0.3;

  /// In a box of side `box_side` [mm]; the fit uses |q| <= q_max [1/mm].
  DirectorFluctuations(double box_side, double q_max);

  /// Centres (n_rods) [mm] and directors (n_rods). Rods exactly upright, or not finite, are left out.
  void accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors);
  /// Adds the samples of `other`, of the same box.
  void merge(const DirectorFluctuations& other);

  /// With errors from the stretches of `blocks` from `t_steady` [s] on. The fit is by weighted least squares of the
  /// powers with weights iterated from the fit itself, 1 / (fit + floor)^2, as powers scatter by as much as they are:
  /// the same as the maximum likelihood of exponentially distributed ones (Whittle 1953). Powers less the floor may be
  /// negative; waves well below the floor hardly count. NaN where there is no fit.
  static DirectorSpectrum reduce(const Blocked<DirectorFluctuations>& blocks, double t_steady);

  static constexpr const char* kName = "DirectorFluctuations";
  static auto fields(auto& self) {
    return listed(Setting{"box", self.box_side_}, Setting{"range", self.q_max_}, Length{self.sectors_}, self.sectors_);
  }

 private:
  static constexpr int kModes = 84;  // |m|, |n| <= 6; q and -q are one
  struct Sector : Summed<Sector> {
    std::int64_t place = 0;  // of the director's angle
    std::int64_t samples = 0;
    double cosine = 0, sine = 0;         // sums of cos, sin of twice the director's angle
    double floor = 0;                    // sum
    std::array<double, kModes> power{};  // sums, without the floor
    static auto fields(auto& self) {
      return listed(Largest{self.place}, self.samples, self.cosine, self.sine, self.floor, self.power);
    }
  };
  struct Point {
    double along2, across2;  // q_along^2, q_across^2 [1/mm^2]
    double power, floor;     // mean [mm^2]
    double samples;
  };
  Sector& sector_at(std::int64_t place);
  std::vector<Point> points() const;
  std::vector<double> numbers() const;

  double box_side_, q_max_;
  std::vector<Sector> sectors_;  // those with samples, by place
};

}  // namespace shaken::analysis
