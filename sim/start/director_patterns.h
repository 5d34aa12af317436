#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"
#include "sim/system.h"

/// Director fields that rods may start along.
namespace shaken {

/// The director, a unit vector whose sign means nothing, at a place in the box [mm].
using DirectorAt = std::function<Vec2(const Vec2&)>;

/// A domain of one director.
struct Domain {
  Vec2 centre;    ///< [mm]
  Vec2 director;  ///< unit vector
};

/// `n` domains of a periodic box. Each centre is the one of ten random places that is furthest from the centres before
/// it, so that no two are close (Mitchell, Computer Graphics 25, 157 (1991), "best candidate"). The angles of the
/// directors are spread evenly over the half circle, from a random one on, and dealt to the domains at random: with two
/// or more domains of equal area S of the whole is 0.
std::vector<Domain> draw_domains(const Box& box, int n, std::uint64_t seed);

/// The director of the domain whose centre is nearest (Voronoi cells of the periodic box).
DirectorAt director_of_domains(const Box& box, std::vector<Domain> domains);

/// Where a pair of defects lies: in the middle of the box, one behind the other along its longer side (along x in a
/// square).
struct DefectPair {
  Vec2 plus;   ///< of charge +1/2, at the smaller coordinate [mm]
  Vec2 minus;  ///< of charge -1/2 [mm]
};
DefectPair defect_pair(const Box& box, double separation);

/// The director field of that pair in a periodic box, of least distortion (one Frank constant): harmonic but for the
/// two defects, and periodic. On the line through both it is at `angle` [rad] to x outside of the pair, and across that
/// between the two; the head of the +1/2 points to the -1/2 if `angle` is that of this line, and away from it if it is
/// across.
///
/// Method: theta = angle + (1/2) arg f with f(z) = theta_1(pi (z - z_+) / W | i L / W) / theta_1(pi (z - z_-) / W | i L
///         / W), Jacobi's function, which has one zero in each box; z = x + i y, turned so that the imaginary axis lies
///         along the longer side L, and W is the shorter one. Across, z -> z + W leaves f as it is; along, z -> z + i L
///         multiplies it by exp(2 pi i (z_+ - z_-) / W) (DLMF 20.2.6). z_+ - z_- is imaginary, so that this factor is a
///         positive number and the field is periodic. (Of a pair that lies otherwise arg f is not: it needs a
///         linear term besides.) The sum over images in any other order differs by such a term, as that over dipoles
///         does in two dimensions.
/// Source: for vortices, which are the same but for the half, O'Neil, J. Math. Phys. 30, 1373 (1989).
/// Numerics: theta_1 as the product of sin(pi (z - z_+ - i n L) / W) over |n| <= 6: further factors of numerator and
///         denominator have equal phases to the last bit. The director is the half of the phase by square roots:
///         the same bits on every machine.
DirectorAt director_of_defect_pair(const Box& box, double separation, double angle);

/// The pattern that `system` starts along; none if it does not start along one.
DirectorAt start_pattern(const System& system);

/// A field that turns rods towards a director pattern: the pattern's order tensor, smoothed, on a grid over a periodic
/// box. It is weak at defects and at seams of domains, where rods find their own directions: held there, they would
/// leave a void.
class AligningField {
 public:
  /// Smoothed by diffusion to a Gaussian of standard deviation `smoothing` [mm]; meshes are a quarter of it at most.
  AligningField(const Box& box, const DirectorAt& directors, double smoothing);

  /// sin 2 delta times the strength of the field, in [0, 1], for a rod along the unit vector `along` at `place` [mm],
  /// anywhere; delta is the angle to the field's director, positive if the rod has to turn counterclockwise.
  double torque(const Vec2& place, const Vec2& along) const;

 private:
  const Vec2& at(int i, int j) const { return q_[static_cast<std::size_t>(j) * columns_ + i]; }
  void diffuse();

  Box box_;
  int columns_, rows_;
  std::vector<Vec2> q_;  ///< (rows_ * columns_), i fastest: (cos, sin) of twice the angle, and shorter by the smoothing
};

}  // namespace shaken
