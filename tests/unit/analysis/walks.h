#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::analysis {

/// Positions of all rods, sample by sample.
using Frames = std::vector<std::vector<Vec3>>;

/// Independent walks with steps of spread `along` and `across` an axis at `theta`.
inline Frames walks(Draw& draw, std::size_t n_rods, std::size_t n_frames, double theta, double along, double across) {
  Frames frames{std::vector<Vec3>(n_rods, Vec3::Zero())};
  const Vec3 n(std::cos(theta), std::sin(theta), 0), m(-std::sin(theta), std::cos(theta), 0);
  while (frames.size() < n_frames) {
    std::vector<Vec3> next = frames.back();
    for (Vec3& r : next) r += along * draw.normal() * n + across * draw.normal() * m;
    frames.push_back(next);
  }
  return frames;
}

/// The same, where one rod in ten is missed by chance.
inline Frames with_holes(Draw& draw, Frames frames) {
  for (std::vector<Vec3>& frame : frames) {
    for (Vec3& place : frame) {
      if (draw.uniform(0, 1) < 0.1) place.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return frames;
}

/// The spacing of the origins that a lag [samples] of LagAverage uses.
inline std::size_t origin_spacing(std::size_t lag) {
  std::size_t spacing = 1;
  while (lag > 8 * spacing) spacing *= 2;
  return spacing;
}

}  // namespace shaken::analysis
