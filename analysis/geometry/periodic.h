#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "base/core/check.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// An angle of a head-tail symmetric axis, brought into [-pi/2, pi/2) by adding a multiple of pi.
inline double fold_half_turn(double theta) {
  const double folded = theta - kPi * std::floor(theta / kPi + 0.5);
  // Rounding can leave the result on the excluded end, or just below the included one.
  if (folded >= kPi / 2) return folded - kPi;
  return folded < -kPi / 2 ? -kPi / 2 : folded;
}

/// cos 2 theta and sin 2 theta of a rod's in-plane direction; (0, 0) for a rod that stands exactly upright and has
/// none.
inline Vec2 double_angle(const Vec3& director) {
  const double x2 = director.x() * director.x();
  const double y2 = director.y() * director.y();
  const double norm = x2 + y2;
  if (norm == 0.0) return Vec2::Zero();
  return Vec2((x2 - y2) / norm, 2.0 * director.x() * director.y() / norm);
}

/// A coordinate brought into [0, box_side) by a multiple of the period.
inline double wrapped(double x, double box_side) {
  const double inside = x - box_side * std::floor(x / box_side);
  return inside < box_side ? inside : 0.0;  // rounding can reach the end
}

/// The rods of a frame that have a direction in the plane, in columns, over which loops become vector instructions.
struct LyingRods {
  std::vector<double> x, y;  ///< within the box
  std::vector<double> c, s;  ///< double_angle
};

inline LyingRods lying_rods(std::span<const Vec3> positions, std::span<const Vec3> directors, const Vec2& box) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  LyingRods rods;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec2 angle = double_angle(directors[i]);
    if (angle == Vec2::Zero()) continue;
    rods.x.push_back(wrapped(positions[i].x(), box.x()));
    rods.y.push_back(wrapped(positions[i].y(), box.y()));
    rods.c.push_back(angle.x());
    rods.s.push_back(angle.y());
  }
  return rods;
}

/// The difference of two wrapped coordinates, brought into [-box_side / 2, box_side / 2] by a period, without a branch.
inline double wrapped_difference(double difference, double box_side) {
  return difference - box_side * static_cast<double>(static_cast<int>(difference * (2 / box_side)));
}

}  // namespace shaken::analysis
