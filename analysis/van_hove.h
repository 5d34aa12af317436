#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/summed.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// Displacements at one lag, by their magnitude; all of shape (bins). NaN without displacements.
struct DisplacementCurve {
  std::vector<double> displacement;  ///< bin centres [mm]
  /// G_s(x) of the displacement x along the director at the origin time, and across it: densities over all x, of either
  /// sign, which share what the two bins at +-x hold [1/mm].
  std::vector<double> along, across;
  std::vector<double> distance;  ///< density of the distance |r| in the plane, 2 pi r G_s(r) [1/mm]
  /// Share of the displacements in the plane that are longer than the range.
  double beyond = 0;
};

/// Histograms of displacements at one lag.
class DisplacementHistogram : public Summed<DisplacementHistogram> {
 public:
  /// `bins` equal bins over [0, range) [mm].
  DisplacementHistogram(int bins, double range);

  /// Displacements (n_rods) [mm], and the angle of the nematic director at their beginning [rad].
  void accumulate(std::span<const Vec2> displacements, double director);
  DisplacementCurve reduce() const;

  static constexpr const char* kName = "DisplacementHistogram";
  static auto fields(auto& self) {
    return listed(Setting{"range", self.range_}, self.rods_, self.along_, self.across_, self.distance_);
  }

 private:
  double range_;
  std::int64_t rods_ = 0;  // of all samples
  std::vector<std::int64_t> along_, across_, distance_;
};

/// Self part of the van Hove function (van Hove, Phys. Rev. 95, 249 (1954)) in the plane, while the run goes on: how
/// displacements at up to four lags are distributed. Each lag is a quarter of the next, and its range half of it, as
/// diffusion has it. An origin follows the one before by one lag, so that no two displacements of a rod overlap.
class VanHove : public Saved<VanHove> {
 public:
  /// `interval`: time between successive accumulate calls [s]. Lags are `longest`, `longest` / 4, / 16 and / 64 [s],
  /// rounded to multiples of it, at least one; of equal ones the first remains. `range` is that of the longest [mm].
  VanHove(double interval, double longest, int bins, double range);

  /// At `time` [s]: unwrapped centres (n_rods) [mm], and the angle of the nematic director [rad]; n_rods is the same in
  /// every call.
  void accumulate(double time, std::span<const Vec3> unwrapped, double director);

  std::size_t n_lags() const { return lags_.size(); }
  /// Rising with k [s].
  double lag(std::size_t k) const { return static_cast<double>(lags_[k].steps) * interval_; }
  /// By the time of their origins.
  const Blocked<DisplacementHistogram>& displacements(std::size_t k) const { return lags_[k].displacements; }

  static constexpr const char* kName = "VanHove";
  static auto fields(auto& self) { return listed(self.lags_); }

 private:
  struct Lag {
    std::int64_t steps;  // of the interval
    Blocked<DisplacementHistogram> displacements;
    std::int64_t passed = 0;   // steps since the origin
    double time = 0;           // of the origin
    double director = 0;       // there
    std::vector<double> x, y;  // of the rods there; empty before the first sample
    static auto fields(auto& self) {
      return listed(Setting{"lag", self.steps}, self.passed, self.time, self.director, Growing{self.x, self.y},
                    self.displacements);
    }
    bool is_sound() const { return passed < steps; }
  };

  double interval_;
  std::vector<Lag> lags_;
};

}  // namespace shaken::analysis
