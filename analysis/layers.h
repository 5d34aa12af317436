#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "analysis/geometry/wave_sums.h"
#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Power of s_i = sin 2 (theta_i - theta_N) against wave number, |sum_i s_i exp(-i q . r_i)|^2 / N, averaged over the
/// wave vectors of the box within half a step of q and within 30 degrees of an axis. All of shape (shells); NaN where
/// the box has no such wave vector. Without correlation it is <s^2>.
struct LayerSpectrum {
  std::vector<double> q;       ///< 2 pi k / L of the longer side, k = 1, 2, ... [rad/mm]
  std::vector<double> across;  ///< wave vectors along the normal to the director
  std::vector<double> along;   ///< along the director
};

/// A wave of the rods' angle to the nematic director, across that director.
struct LayerPeak {
  int m = 0, n = 0;       ///< the wave vector 2 pi (m / L_x, n / L_y) with the most power
  double side = 0;        ///< of the box, the one that the wave vector lies along more than along the other [mm]
  double wavelength = 0;  ///< [mm]; of the mean wave vector, see below
  double order = 0;       ///< 2 |sum_i s_i exp(-i q . r_i)| / N, root mean square over time
  double floor = 0;       ///< 2 sqrt(<s^2> / N), the order without layers or any other correlation
  /// Twice the floor: among rods without correlation the largest wave of a thousand gets there by chance in fewer than
  /// about five independent samples only. Says nothing of why: the long waves of a nematic stand out as well.
  bool stands_out() const { return order > 2 * floor; }
};

/// Order of the layered phase: stripes along the nematic director, in which rods are turned by
/// +-theta_m in the plane, to either side by turns. theta_N is the angle of the nematic director of the same instant.
/// The peak is looked for among wave vectors within 30 degrees of the normal to the director. Its order is the
/// amplitude of the wave in s: a for s = a sin(q . r), (4 / pi) sin 2 theta_m for stripes of equal width at +-theta_m
/// (0.435 at 10 degrees), 2 sqrt(<s^2> / N) without layers, somewhat more as the peak is the largest of many. Layers
/// that turn out of the cone count as none while they do. Waves must divide the box, so that wavelengths come in steps
/// of about lambda^2 / L, and the one that rods would have in a box without end is known no better than to
/// lambda^2 / (L sqrt(12)), the spread over one step: quote L / lambda, L being the side of the box across the layers.
/// The wavelength is that of the mean of the peak's wave vector and its neighbours (m +- 1, n +- 1), each with its mean
/// power while it was within the cone, in opposite pairs so that a flat background does not move it; pairs of which one
/// was there for less than half as long as the peak are left out. A wavelength near L is the long-wave bend of a
/// nematic, not layers.
class LayerOrder : public Summed<LayerOrder> {
 public:
  /// Waves no shorter than `shortest` [mm], and at most 40 of them to the side of a square box; of another as many
  /// wave vectors.
  LayerOrder(const Box& box, double shortest);

  /// Centres (n_rods) [mm] and directors (n_rods). Rods exactly upright are left out; without any other, nothing
  /// counts.
  void accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors);
  LayerSpectrum reduce() const;
  /// The peak with the most power; none without samples.
  std::optional<LayerPeak> peak() const;
  /// The same of the wave vector (m, n), m >= 0, which need not have the most.
  LayerPeak peak_at(int m, int n) const;

  static constexpr const char* kName = "LayerOrder";
  static auto fields(auto& self) {
    return listed(Setting{"box", self.vectors_}, self.samples_, self.floor_, self.amplitudes_, self.within_,
                  self.across_, self.along_, self.n_across_, self.n_along_);
  }

 private:
  /// A wave vector that is kept has a place in the tables, as has its opposite.
  std::optional<std::size_t> find(int m, int n) const;
  /// Mean of 4 |sum|^2 / N^2, which is 0 while the wave vector is out of the cone; 0 beyond those that are kept.
  double power(int m, int n) const;
  /// The mean over the samples with the wave vector within the cone; none where they are fewer than `at_least`.
  std::optional<double> power_within(int m, int n, std::int64_t at_least) const;

  WaveVectors vectors_;
  std::int64_t samples_ = 0;
  double floor_ = 0;                              // sum over samples of 4 <s^2> / N
  std::vector<double> amplitudes_;                // (vectors), sum over samples of 4 |sum|^2 / N^2 within the cone
  std::vector<std::int64_t> within_;              // (vectors), samples with the wave vector within the cone
  std::vector<double> across_, along_;            // (shells) sums of |sum|^2 / N
  std::vector<std::int64_t> n_across_, n_along_;  // (shells) terms of them
};

}  // namespace shaken::analysis
