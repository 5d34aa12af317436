// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/state_io.h"
#include "sim/core/types.h"

namespace shaken::analysis {

/// In-plane mean square displacements; all of shape (lags met so far).
struct MsdCurve {
  std::vector<double> lag;     ///< [s], rising
  std::vector<double> total;   ///< [mm^2], = along + across
  std::vector<double> along;   ///< along the nematic director at the origin time [mm^2]
  std::vector<double> across;  ///< across it [mm^2]
};

/// Mean square displacement against lag, while the run goes on. "Along" and "across" refer to the nematic director of
/// all rods at the origin time, not to the single rod.
/// Level k of `n_levels` keeps the last 8 of every 2^k-th sample and gives the lags (1..8 for k = 0, 5..8 else) 2^k:
/// four an octave up to 8 * 2^(n_levels - 1) samples, exact, without averaging. Memory is at most 128 bytes per level
/// and rod, however long the run.
class MeanSquareDisplacement {
 public:
  /// `interval`: time between successive accumulate calls [s].
  explicit MeanSquareDisplacement(double interval, int n_levels = 16);

  /// Unwrapped centres (n_rods) [mm] and directors (n_rods); n_rods is the same in every call.
  void accumulate(std::span<const Vec3> unwrapped, std::span<const Vec3> directors);
  MsdCurve reduce() const;
  void reset();

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  static constexpr int kFrames = 8;
  /// One sample kept as an origin.
  struct Frame {
    std::vector<double> x, y;  // (n_rods) unwrapped [mm]
    double director = 0;       // of all rods at that time [rad]
  };
  struct Level {
    std::vector<Frame> frames;  // the last kFrames samples; sample f is at f % kFrames
    std::int64_t n_frames = 0;  // taken so far
  };
  std::size_t n_rods() const { return calls_ == 0 ? 0 : levels_[0].frames[0].x.size(); }
  void add(std::size_t k, const std::vector<double>& x, const std::vector<double>& y, double director);

  double interval_;
  std::vector<Level> levels_;
  std::vector<double> along_, across_;  // (n_levels * kFrames) sums over origins of the mean over rods
  std::vector<std::int64_t> origins_;   // (n_levels * kFrames)
  std::int64_t calls_ = 0;
};

}  // namespace shaken::analysis
