#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/estimate_curve.h"
#include "analysis/errors/saved.h"
#include "analysis/geometry/director_field.h"
#include "analysis/geometry/region.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// What density maps come down to. delta is the density of a cell over its mean in the region, less 1; means over cells
/// are weighted by their area within walls.
struct DensitySummary {
  std::vector<double> mean;   ///< (rows * columns) density over its mean in the region, over all maps; NaN outside
  Estimate variance;          ///< mean of delta^2 over cells and maps
  Estimate variance_of_mean;  ///< that of the mean map: what does not change in time
  std::vector<double> lag;    ///< (n) [s], from 0 on
  EstimateCurve correlation;  ///< (n) <delta(t) delta(t + lag)> / <delta^2>
  Estimate correlation_time;  ///< where it falls to 1/e [s]
};

/// Numbers of centres in the cells of a grid over the box, averaged over times of `samples_per_map` samples, one after
/// the other; all maps are kept. A cell's area is what of it lies within walls, counted at 32 x 32 places; a cell of
/// which less than a tenth does is left out, with the rods in it.
class DensityMaps : public Saved<DensityMaps> {
 public:
  /// The least share of a cell within walls of which anything is said.
  static constexpr double kLeastShare = 0.1;

  /// `interval` between samples [s].
  DensityMaps(const Region& region, const Grid& grid, double interval, std::int64_t samples_per_map);

  /// Centres at `time` [s], later than all before (n_rods, the same in every call) [mm].
  void accumulate(double time, std::span<const Vec3> positions);

  const Grid& grid() const { return grid_; }
  const std::vector<double>& times() const { return times_; }  ///< (n_maps) mean time of the samples of a map [s]
  /// (n_maps * rows * columns) density over the mean one in the region, x fastest; NaN where a cell is left out.
  const std::vector<double>& densities() const { return densities_; }
  /// Over the maps that begin at `t_steady` [s] or later.
  DensitySummary reduce(double t_steady) const;

  static constexpr const char* kName = "DensityMaps";
  static auto fields(auto& self) {
    return listed(self.samples_, self.time_, self.counts_, Growing{self.times_}, Growing{self.densities_});
  }
  bool is_sound() const { return samples_ < samples_per_map_ && densities_.size() == times_.size() * counts_.size(); }

 private:
  /// Products of delta at map `a` and at map `b`, mean over cells.
  double product(std::size_t a, std::size_t b) const;

  Grid grid_;
  Region region_;
  double interval_;
  std::int64_t samples_per_map_;
  std::vector<double> share_;         // (rows * columns) of each cell within walls, in all 1; 0: left out
  std::vector<double> area_;          // (rows * columns) [mm^2]
  std::vector<std::int64_t> counts_;  // (rows * columns) of the map that is not complete
  std::int64_t samples_ = 0;          // of that
  double time_ = 0;                   // sum of its times [s]
  std::vector<double> times_, densities_;
};

}  // namespace shaken::analysis
