#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/bounded_series.h"
#include "analysis/errors/summed.h"
#include "analysis/geometry/region.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Shortest distance of two segments from `a` to `a` + `along_a` and from `b` to `b` + `along_b` [mm]; either may be a
/// point, and they may be parallel. Source: Ericson, Real-Time Collision Detection (2005), section 5.1.9.
double segment_distance(const Vec3& a, const Vec3& along_a, const Vec3& b, const Vec3& along_b);

/// How far a rod's axis reaches from its centre, to the centres of the end beads [mm].
struct RodAxis {
  double tail = 0, head = 0;
};

/// When two rods are neighbours in a cluster.
struct ClusterRule {
  double distance = 0;     ///< the axes are nearer than this at one point [mm]
  double angle = kPi / 2;  ///< and the angle between them, regardless of heads, is no larger than this [rad]
};

/// Number of rods in each cluster, the largest first. Rods are of one cluster if a chain of neighbours leads from one
/// to the other. In a periodic box neighbours are sought at the nearest image of the centre.
/// @param positions   (n_rods) centres, x and y in the box [mm]
/// @param directors   (n_rods) unit vectors
/// @param axes        (n_rods), or the one that all rods have
std::vector<std::size_t> cluster_sizes(std::span<const Vec3> positions, std::span<const Vec3> directors,
                                       std::span<const RodAxis> axes, const Region& region, const ClusterRule& rule);

/// Sizes are counted by octaves: octave k holds the sizes from 2^k on, below 2^(k + 1).
inline constexpr std::size_t kClusterOctaves = 21;

/// Clusters in numbers. NaN without samples.
struct ClusterNumbers {
  double largest = 0;  ///< share of all rods that are in the largest cluster
  double size = 0;     ///< mean over rods of the number of rods in their cluster, <s^2> / <s>
  double alone = 0;    ///< share of rods without a neighbour
  double per_rod = 0;  ///< clusters over rods; a rod alone is a cluster
  /// By octave: share of rods in clusters of its sizes, and clusters of one size per rod, n(s), mean over its sizes.
  std::array<double, kClusterOctaves> rods{}, density{};
};

/// Clusters over the samples of a run.
class ClusterStatistics : public Summed<ClusterStatistics> {
 public:
  /// Sizes as of cluster_sizes().
  void accumulate(const std::vector<std::size_t>& sizes);
  ClusterNumbers reduce() const;

  static constexpr const char* kName = "ClusterStatistics";
  static auto fields(auto& self) {
    return listed(self.samples_, self.largest_, self.rods_, self.squares_, self.alone_, self.clusters_of_,
                  self.rods_of_);
  }

 private:
  using Octaves = std::array<double, kClusterOctaves>;
  std::int64_t samples_ = 0;
  double largest_ = 0;  // sum of the largest clusters' shares
  double rods_ = 0;     // of all samples
  double squares_ = 0;  // sum of the squares of sizes
  double alone_ = 0;
  Octaves clusters_of_{}, rods_of_{};
};

/// The largest cluster and the mean size against time, in bounded memory (see BoundedSeries).
class ClusterSeries : public Saved<ClusterSeries> {
 public:
  /// Takes a sample at `time` [s], later than all before: sizes as of cluster_sizes().
  void accumulate(double time, const std::vector<std::size_t>& sizes);

  const std::vector<double>& times() const { return series_.times(); }      ///< (n) [s]
  const std::vector<double>& largest() const { return series_.column(0); }  ///< (n) share of all rods
  const std::vector<double>& sizes() const { return series_.column(1); }    ///< (n) mean over rods

  static auto fields(auto& self) { return listed(self.series_); }

 private:
  BoundedSeries<2> series_;
};

}  // namespace shaken::analysis
