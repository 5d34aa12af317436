// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/state_io.h"
#include "sim/core/types.h"

namespace shaken::analysis {

/// Mean velocity against tilt; all of shape (bins). A bin without samples has NaN velocities, a bin met in fewer than
/// two blocks NaN errors.
struct TiltCurve {
  std::vector<double> n_z;           ///< bin centres
  std::vector<double> v_along;       ///< along the rod's in-plane direction [mm/s]
  std::vector<double> v_along_sem;   ///< standard error of the mean [mm/s]
  std::vector<double> v_across;      ///< across it, to the left [mm/s]
  std::vector<double> v_across_sem;  ///< [mm/s]
  std::vector<double> density;       ///< P(n_z), per unit n_z; its integral is the share of samples within +-n_z_max
};

/// Mean in-plane velocity of rods against the vertical component n_z of their director (Sharma & Soni 2024, figure on
/// v^n(n_z)): along n_xy / |n_xy|, and across it, along z x n_xy / |n_xy|. The sign of a director is a label that its
/// rod carries; nothing is symmetrised, so that v_along is odd in n_z is a measurement.
/// Successive samples are correlated. The errors come from the scatter between blocks of successive accumulate calls,
/// 20 to 40 blocks whose length doubles as the run goes on: right once a block is longer than the correlation time.
class TiltVelocity {
 public:
  /// `bins` equal bins over [-n_z_max, n_z_max].
  TiltVelocity(int bins, double n_z_max);

  /// Director (n_rods) and velocity of the centre (n_rods) [mm/s] at one instant. Rods exactly upright are left out.
  void accumulate(std::span<const Vec3> directors, std::span<const Vec3> velocities);
  TiltCurve reduce() const;
  void reset();
  /// Appends the later samples of `other`, which has the same bins.
  void merge(const TiltVelocity& other);

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  /// Sums over successive accumulate calls.
  struct Block {
    std::int64_t calls = 0;
    std::int64_t outside = 0;          // samples beyond +-n_z_max
    std::vector<std::int64_t> counts;  // (bins)
    std::vector<double> along;         // (bins) sum of v_along
    std::vector<double> across;        // (bins) sum of v_across
    void add(const Block& other);
  };
  Block empty_block() const;
  void halve_blocks();

  int bins_;
  double n_z_max_;
  std::int64_t calls_per_block_ = 1;
  std::vector<Block> blocks_;  // in order of time; the last may still be filling
};

}  // namespace shaken::analysis
