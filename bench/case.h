// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "bench/options.h"
#include "scene/run_plan.h"

namespace shaken::bench {

/// A scene whose speed is measured, in its user's terms and resolved. Everything not named here is the scene file's
/// default.
struct Case {
  double length = 0;         ///< of the rods, tip to tip [mm]
  double area_fraction = 0;  ///< asked for; that of a whole number of rods differs a little
  double side = 0;           ///< of the box [mm]
  double dt = 0;             ///< [s]
  double warm_up = 0;        ///< simulated before anything is measured [s]
  scene::RunPlan plan;       ///< `plan.system` is the scene; the run lasts for `warm_up`

  const Scene& system() const { return plan.system; }
  Tick warm_up_ticks() const;
  /// Ticks of one vibration, rounded.
  Tick period_ticks() const;
  /// Rod-seconds that `ticks` simulate.
  double rod_seconds(Tick ticks) const;
  /// "l = 4.5 mm, phi = 0.75, L = 41.865 mm"
  std::string label() const;
};

/// The values that a scene's field may have, in its default unit.
std::pair<double, double> limits_of(std::string_view field);

/// Fills in the plan. Whatever is wrong goes to `options`; then there is no case.
std::optional<Case> make_case(double length, double area_fraction, double side, double dt, double warm_up,
                              OptionReader& options);

}  // namespace shaken::bench
