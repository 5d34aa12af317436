#pragma once

#include <cstdint>
#include <span>

#include "analysis/errors/summed.h"
#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Order of the places of the rods, averaged over samples; NaN without any.
struct LatticeMeans {
  double psi_6 = 0;        ///< |<psi_6j>_j| in coordinates compressed along the director
  double psi_6_local = 0;  ///< <|psi_6j|>_j, the same without regard to other rods' axes
  double psi_6_raw = 0;    ///< |<psi_6j>_j| in coordinates as they are; high also where all six stand in a row
  double bragg_peak = 0;   ///< max over q of |sum exp(-i q . r)|^2 / N^2
  static auto fields(auto& self) { return listed(self.psi_6, self.psi_6_local, self.psi_6_raw, self.bragg_peak); }
};

/// Two measures of a crystal.
/// psi_6j is the mean of exp(6 i a) over the bonds of rod j to its six nearest neighbours (neighbours as far as the
/// sixth share the places that are left), a being the bond's angle to the director. A hexagonal lattice, compressed
/// across by rods that are `ratio` times as long as wide, has psi_6 = 1; a square one has 0, a gas 1 / sqrt(6 N) with
/// psi_6_local = 0.37.
/// The Bragg peak is the largest among the wave vectors of the box with wavelengths between `shortest` and `longest`, 1
/// for a perfect lattice that fits the box, about ln(number of wave vectors) / N for a gas.
/// One sample takes at most 1024 rods, of more one of each k successive ones: N above is their number. Which one is
/// left to chance, since every k-th rod of a lattice counted through makes a lattice of its own, with peaks at
/// wavelengths that the rods do not have, and higher ones as those are longer. Neighbours are taken from all rods.
/// Neighbours must be nearer than half the box: not so with fewer than some fifty rods. Fewer than seven rods have no
/// psi_6, which is NaN, and no rod counts as no sample.
class LatticeOrder : public Summed<LatticeOrder> {
 public:
  struct Shape {
    Box box;
    double ratio;     ///< of a rod's length to its width; distances along the director are divided by it
    double shortest;  ///< wavelength [mm]; at most 128 waves to the side of a square box are looked at,
                      ///< and as many wave vectors of another
    double longest;   ///< [mm]
    friend bool operator==(const Shape&, const Shape&) = default;
    static auto fields(auto& self) { return listed(self.box, self.ratio, self.shortest, self.longest); }
  };
  explicit LatticeOrder(const Shape& shape);

  /// Centres (n_rods) [mm] and directors (n_rods); of the latter only the mean axis is used.
  void accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors);
  /// Samples that others have taken before: which rods are taken next depends on it.
  void start_at(std::int64_t samples) { calls_ = samples; }
  LatticeMeans reduce() const;

  static constexpr const char* kName = "LatticeOrder";
  static auto fields(auto& self) {
    return listed(Setting{"shape", self.shape_}, Largest{self.calls_}, self.samples_, self.sums_);
  }

 private:
  Shape shape_;
  std::int64_t calls_ = 0;  // samples so far, those before start_at included
  std::int64_t samples_ = 0;
  LatticeMeans sums_;
};

}  // namespace shaken::analysis
