#pragma once

#include "base/core/types.h"

namespace shaken {

/// An ellipse round the origin, with its long axis along x, seen from within.
///
/// Model: with half axes a >= b and e^2 = 1 - b^2 / a^2, a disc about (e^2 a u, 0) of radius b sqrt(1 - e^2 u^2) lies
/// within the ellipse and touches it at (a u, +-b sqrt(1 - u^2)), for |u| <= 1. For u = 1 it is the disc of curvature
/// at the tip, of radius b^2 / a, the least of all. The ellipse is the union of these discs. So the distance of a
/// point to the ellipse is, of the discs, the greatest radius less the distance to the centre, and that disc touches at
/// the nearest point of the ellipse. Any other disc gives a lower bound.
/// Numerics: + - * / and sqrt only, so that the bits are the same everywhere.
class Ellipse {
 public:
  /// Half axes along x and y, the former not the shorter one [mm].
  Ellipse(double a, double b);

  /// A disc within the ellipse that touches it.
  struct Disc {
    double centre;  ///< along x [mm]
    double radius;  ///< [mm]
    /// Distance of a point to its rim, positive within [mm].
    double depth(const Vec2& point) const;
  };
  /// That which touches at the x coordinate a u, for |u| <= 1.
  Disc disc_at(double u) const;
  /// That which touches above or below the point, but for its ends: near the ellipse one of the deepest round it.
  Disc disc_round(const Vec2& point) const;

  /// The u >= 0 at which the point of the ellipse nearest to (|x|, |y|) lies.
  ///
  /// Model: with w = x - e^2 a u and D = |(w, y)|, the depth in the disc at u is greatest where f = w / D - m = 0; here
  /// m = b u / (a sqrt(1 - e^2 u^2)) is the x component of the outward normal at u. On [0, min(1, x / (e^2 a))], where
  /// w >= 0, f falls and is concave, f(0) >= 0, and f <= 0 at the end. So one step of Newton's method, kept within,
  /// leads beyond the root, and all others fall towards it: they end when rounding stops them.
  double nearest(const Vec2& point) const;

  /// Distance of a point to the ellipse, positive within [mm], and the unit normal at the nearest point, inwards.
  struct Seen {
    double distance;
    Vec2 normal;
  };
  Seen see(const Vec2& point) const;

 private:
  double a_, b_;
  double ratio_;     ///< b / a
  double squared_;   ///< e^2
  double furthest_;  ///< centre of the disc at the tip: e^2 a
};

}  // namespace shaken
