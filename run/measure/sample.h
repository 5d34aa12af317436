#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "analysis/collision_rates.h"
#include "analysis/order.h"
#include "analysis/stress.h"
#include "sim/snapshot.h"

namespace shaken::run {

/// Totals of all rods of a run, whatever their species, up to a tick.
struct RunTotals {
  analysis::CollisionTotals collisions{};
  analysis::StressTotals stress{};
};

/// The measured rods at one tick, with what several measurements need of them, worked out once and only on demand.
class Sample {
 public:
  /// A sample of the measured `rods` among `all`, which must outlive it.
  Sample(const Snapshot& rods, const Snapshot& all, const RunTotals& totals)
      : rods_(rods), all_(all), totals_(totals) {}

  const Snapshot* operator->() const { return &rods_; }
  /// Rods of all species.
  const Snapshot& all() const { return all_; }
  const RunTotals& totals() const { return totals_; }
  /// Nematic order and director of all rods.
  const analysis::NematicOrder& order() const {
    if (!order_) order_ = analysis::nematic_order(rods_.director);
    return *order_;
  }
  /// Centres without the jumps at the borders of the box [mm], of rods that are followed (Snapshot::by_track).
  const std::vector<Vec3>& unwrapped() const {
    if (unwrapped_.empty()) {
      for (std::size_t i = 0; i < rods_.n_rods(); ++i) unwrapped_.push_back(rods_.unwrapped(i));
      unwrapped_ = rods_.by_track(std::move(unwrapped_));
    }
    return unwrapped_;
  }

 private:
  const Snapshot& rods_;
  const Snapshot& all_;
  RunTotals totals_;
  mutable std::optional<analysis::NematicOrder> order_;
  mutable std::vector<Vec3> unwrapped_;
};

}  // namespace shaken::run
