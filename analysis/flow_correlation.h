#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/summed.h"
#include "analysis/geometry/region.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Correlation of the velocities of two rods against their distance; all of shape (bins). NaN where no pair was met or
/// nothing moves.
struct FlowCurve {
  std::vector<double> r;       ///< bin centres [mm]
  std::vector<double> c;       ///< <v_i . v_j> / <v^2>, in the plane
  std::vector<double> along;   ///< of the components along the nematic director, over their own mean square
  std::vector<double> across;  ///< of those across it
  double near = 0;             ///< c of all pairs nearer to each other than `near_distance`
  /// Where c, taken as 1 at r = 0 and between bins as an exponential, first falls to 1/e [mm]; NaN if it does not
  /// within the range.
  double length = 0;
};

/// Sums of products of velocities over pairs, by their distance.
class FlowSums : public Summed<FlowSums> {
 public:
  /// `bins` equal bins over [0, r_max) [mm].
  FlowSums(int bins, double r_max, double near_distance);

  /// Centres in the box (n_rods) [mm] and velocities in the plane [mm/s], and the angle of the nematic director [rad].
  void accumulate(std::span<const Vec2> places, std::span<const Vec2> velocities, double director,
                  const Region& region);
  /// Samples that others have taken before: whose turn it is as the first of a pair depends on it.
  void start_at(std::int64_t samples) { calls_ = samples; }
  FlowCurve reduce() const;

  static constexpr const char* kName = "FlowSums";
  static auto fields(auto& self) {
    return listed(Setting{"range", self.r_max_}, Setting{"distance", self.near_distance_}, Largest{self.calls_},
                  self.pairs_, self.along_, self.across_, self.near_pairs_, self.near_, self.rods_, self.along_squares_,
                  self.across_squares_);
  }

 private:
  double r_max_, near_distance_;
  std::int64_t calls_ = 0;              // samples so far, those before start_at included
  std::vector<std::int64_t> pairs_;     // (bins)
  std::vector<double> along_, across_;  // (bins) of products of components
  std::int64_t near_pairs_ = 0;
  double near_ = 0;        // of v_i . v_j of near pairs
  std::int64_t rods_ = 0;  // of all samples
  double along_squares_ = 0, across_squares_ = 0;
};

/// C(r) = <v_i . v_j> / <v^2> over pairs of rods at distance r (Dombrowski et al., Phys. Rev. Lett. 93, 098103 (2004),
/// who subtract the mean flow; here nothing is subtracted). Velocities are displacements from one sample to the next
/// over the time between, at the places and with the nematic director of the first of both. Rods that do not know of
/// each other have C = 0, rods that all drift together C = 1. Distances are as in OrientationCorrelation, and so is the
/// number of rods that are the first of a pair in one sample, at most 1024.
class FlowCorrelation : public Saved<FlowCorrelation> {
 public:
  /// Pairs nearer than `near_distance` [mm] count for `near`.
  FlowCorrelation(int bins, double r_max, double near_distance);

  /// At `time` [s], later than all before: centres in the box and unwrapped (n_rods) [mm], and the angle of the nematic
  /// director [rad]; n_rods is the same in every call.
  void accumulate(double time, std::span<const Vec3> positions, std::span<const Vec3> unwrapped, double director,
                  const Region& region);
  /// By the time of the first of both samples.
  const Blocked<FlowSums>& sums() const { return sums_; }

  static constexpr const char* kName = "FlowCorrelation";
  static auto fields(auto& self) {
    return listed(self.time_, self.director_, Growing{self.x_, self.y_, self.unwrapped_x_, self.unwrapped_y_},
                  self.sums_);
  }

 private:
  // the last sample; no rods before the first
  double time_ = 0, director_ = 0;
  std::vector<double> x_, y_;  // in the box
  std::vector<double> unwrapped_x_, unwrapped_y_;
  Blocked<FlowSums> sums_;
};

}  // namespace shaken::analysis
