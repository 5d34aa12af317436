#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/summed.h"
#include "analysis/geometry/region.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Distributions of the pairs between species, and how far the species keep apart.
struct MixingCurves {
  std::vector<double> r;               ///< (bins) bin centres [mm]
  std::vector<std::vector<double>> g;  ///< (kinds, bins), by pair_kind(); NaN where there is no such pair
  /// (kinds) of two species a and b: 1 - x / x0, with x the share of neighbours of the other species among those of
  /// both, over rods of either, and x0 that share of rods mixed at random, 2 n_a n_b / (n (n - 1)), n = n_a + n_b. 0:
  /// mixed, 1: apart, below 0: each is among the other. NaN without neighbours, and of a species with itself.
  std::vector<double> segregation;
};

/// g_ab(r) of every two species a <= b: pairs of a rod of a and one of b at the in-plane distance r, over those that a
/// gas of as many has, which is references x n_b (of a species with itself n - 1) over the region's area x what of the
/// ring is in sight. Pairs and references are those of analysis/g2.h, over all rods: sums in either order make one
/// pair.
class PairMixing : public Summed<PairMixing> {
 public:
  /// Number of the pair of two of `species` species, a and b: 11, 12, ..., 22, ... in order.
  static std::size_t pair_kind(std::size_t species, std::size_t a, std::size_t b);
  static std::size_t kinds(std::size_t species) { return species * (species + 1) / 2; }

  /// `bins` equal bins over [0, r_max) [mm]; neighbours are nearer than `near` [mm].
  PairMixing(std::size_t n_species, int bins, double r_max, double near);

  /// Centres (n_rods) [mm] and the species of each (n_rods; empty: all of the first); the shorter side of a periodic
  /// box is at least 2 r_max and 2 near.
  void accumulate(std::span<const Vec3> positions, std::span<const std::uint8_t> species_of, const Region& region);
  /// Samples that others have taken before (see OrientationCorrelation).
  void start_at(std::int64_t samples) { calls_ = samples; }
  MixingCurves reduce() const;

  static constexpr const char* kName = "PairMixing";
  static auto fields(auto& self) {
    return listed(Setting{"range", self.r_max_}, Setting{"distance of neighbours", self.near_}, Largest{self.calls_},
                  self.samples_, self.rods_, self.pairs_, self.expected_, self.neighbours_);
  }

 private:
  double r_max_, near_;
  std::int64_t calls_ = 0;  // samples so far, those before start_at included
  std::int64_t samples_ = 0;
  std::vector<std::int64_t> rods_;        // (n_species) summed over samples
  std::vector<std::int64_t> pairs_;       // (kinds, bins)
  std::vector<double> expected_;          // (kinds, bins) pairs of a gas
  std::vector<std::int64_t> neighbours_;  // (kinds)
};

}  // namespace shaken::analysis
