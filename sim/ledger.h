#pragma once

#include <array>

#include "base/core/exact_sum.h"
#include "base/core/types.h"

namespace shaken {

/// What the rods have at one tick.
struct Content {
  Tick tick = 0;
  double energy = 0;             ///< kinetic, and potential above z = 0 [pJ]
  Vec3 momentum = Vec3::Zero();  ///< [mg mm/s]
};

/// Where energy and momentum came from and went to since tick 0, entered impact by impact; with what the rods had at
/// the start and have now, energy and the momentum that surfaces gave must add up (balance.h).
///
/// An impulse P at a contact where the surfaces move at u before and u' after relative to each other takes the energy
/// -P . (u + u') / 2 out of the relative motion; a surface that moves at V gives its rod P . V besides (Landau &
/// Lifshitz, Mechanics, sections 16 to 17).
struct Ledger {
  // A rod at rest gives the same tiny terms at every tick, and with them the same rounding: hence so many bits.
  using Energy = ExactSum<34>;
  using Momentum = ExactSum<44>;
  Energy lost_rod_rod;               ///< energy lost in impacts of rods with each other [pJ]
  Energy lost_surfaces;              ///< the same with plates and side walls [pJ]
  Energy given;                      ///< energy that moving plates and walls gave [pJ]
  Energy noise;                      ///< energy that rotational noise gave, if positive [pJ]
  std::array<Momentum, 3> momentum;  ///< that plates and walls gave [mg mm/s]
  /// r_a J_b, over impacts of two rods: r is the way from the centre of the first to that of the second when they
  /// touch, J the impulse on the second; xx, xy, yx, yy [mg mm^2/s]. Of this the pressure is made (analysis/stress.h).
  std::array<Momentum, 4> virial;

  /// visit(sum of each ledger) for all sums, in the order of checkpoints, of which former ones have no virial.
  static void each_sum(const auto& visit, bool has_virial, auto&... ledgers) {
    visit(ledgers.lost_rod_rod...);
    visit(ledgers.lost_surfaces...);
    visit(ledgers.given...);
    visit(ledgers.noise...);
    for (std::size_t c = 0; c < 3; ++c) visit(ledgers.momentum[c]...);
    for (std::size_t k = 0; has_virial && k < 4; ++k) visit(ledgers.virial[k]...);
  }
  void add(const Ledger& more) {
    each_sum([](auto& mine, const auto& its) { mine.add(its); }, true, *this, more);
  }
};

}  // namespace shaken
