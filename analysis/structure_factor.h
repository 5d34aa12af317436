#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "analysis/geometry/wave_sums.h"
#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// S(q) against wave number; all of shape (shells). NaN where the box has no such wave vector, and without samples.
struct StructureCurve {
  std::vector<double> q;       ///< 2 pi k / L of the longer side, k = 1, 2, ... [rad/mm]
  std::vector<double> all;     ///< wave vectors in every direction
  std::vector<double> along;   ///< within 30 degrees of the director
  std::vector<double> across;  ///< within 30 degrees of the normal to it
};

/// Static structure factor of the rods' centres in a periodic box,
///   S(q) = |sum_i exp(-i q . r_i)|^2 / N,   q = 2 pi (m / L_x, n / L_y)
/// (Hansen & McDonald, Theory of Simple Liquids, section 4.1), averaged over samples and over the wave vectors whose
/// length is within half a step of 2 pi k / L. The director is that of the same instant. Of rods that do not know of
/// each other it is 1 at every q; N on the reciprocal lattice of a perfect crystal; at long waves var(N) / <N> of the
/// number of rods in a large part of the box. A sample costs 4 n_rods (waves + 1)^2 multiplications.
class StructureFactor : public Summed<StructureFactor> {
 public:
  /// Shells k = 1 .. `waves`.
  StructureFactor(const Box& box, int waves);

  /// Centres (n_rods) [mm] and directors (n_rods); of the latter only the mean axis is used. No rod is no sample.
  void accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors);
  StructureCurve reduce() const;

  static constexpr const char* kName = "StructureFactor";
  static auto fields(auto& self) { return listed(Setting{"box", self.vectors_}, self.all_, self.along_, self.across_); }

 private:
  struct Shells {
    std::vector<std::int64_t> terms;  // (shells) wave vectors, over all samples
    std::vector<double> sums;         // (shells) of S
    static auto fields(auto& self) { return listed(self.terms, self.sums); }
    std::vector<double> means() const;
  };

  WaveVectors vectors_;
  Shells all_, along_, across_;
};

}  // namespace shaken::analysis
