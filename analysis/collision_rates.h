#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/errors/blocked.h"
#include "analysis/errors/bounded_series.h"
#include "analysis/errors/summed.h"

namespace shaken::analysis {

/// What is counted of impacts, and what energy they move.
enum class CollisionCount : std::size_t {
  kRodRod,        ///< impacts of two rods
  kBase,          ///< of a rod with the base
  kLid,           ///< with the lid
  kWalls,         ///< with side walls and posts
  kGiven,         ///< energy that moving plates, walls and noise gave [pJ]
  kLostRodRod,    ///< energy lost in impacts of two rods [pJ]
  kLostSurfaces,  ///< energy lost in impacts with plates, side walls and posts [pJ]
};
inline constexpr std::size_t kCollisionCounts = 7;

/// Counts and energies since the start of a run, by CollisionCount, and the number of rods that they are of.
struct CollisionTotals {
  std::array<double, kCollisionCounts> since_start{};
  double n_rods = 0;
};

/// By CollisionCount: of impacts, those of one rod in a second [Hz], so that an impact of two rods counts for both; of
/// energies, those of one rod in a second [pJ/s].
using CollisionRates = std::array<double, kCollisionCounts>;

/// Sums over stretches of time.
class CollisionSums : public Summed<CollisionSums> {
 public:
  /// What was added during `duration` [s], of `n_rods` rods.
  void accumulate(double duration, double n_rods, const std::array<double, kCollisionCounts>& added);
  /// NaN without any time.
  CollisionRates reduce() const;

  static constexpr const char* kName = "CollisionSums";
  static auto fields(auto& self) { return listed(self.rod_time_, self.added_); }

 private:
  double rod_time_ = 0;  // of all rods [s]
  std::array<double, kCollisionCounts> added_{};
};

/// Rates of impacts and of the energy that they move, from the totals of a run at successive instants: each rate is a
/// mean over the time from one to the next.
class CollisionSeries : public Saved<CollisionSeries> {
 public:
  /// Totals at `time` [s], later than all before.
  void accumulate(double time, const CollisionTotals& totals);

  const std::vector<double>& times() const { return series_.times(); }  ///< (n) ends of these times [s]
  const std::vector<double>& of(CollisionCount count) const {           ///< (n) rates
    return series_.column(static_cast<std::size_t>(count));
  }
  /// By the beginning of these times.
  const Blocked<CollisionSums>& sums() const { return sums_; }

  static constexpr const char* kName = "CollisionSeries";
  static auto fields(auto& self) { return listed(self.samples_, self.time_, self.last_, self.series_, self.sums_); }

 private:
  std::int64_t samples_ = 0;
  double time_ = 0;  // of the last
  std::array<double, kCollisionCounts> last_{};
  BoundedSeries<kCollisionCounts> series_;
  Blocked<CollisionSums> sums_{CollisionSums()};
};

}  // namespace shaken::analysis
