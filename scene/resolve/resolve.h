#pragma once

#include <optional>
#include <vector>

#include "base/keys/draft.h"
#include "scene/keys/keys.h"
#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// Turns what was said into a plan: fills in defaults, derives what follows from the rest, and refuses what contradicts
/// itself or cannot exist. Values with which a problem has been reported take no part, so one mistake is not reported
/// twice. None if there was any problem, here or before.
///
/// Derived, unless given (more than needed must agree to 1e-6, or exactly for whole numbers):
///   Gamma g = a (2 pi f)^2                  a missing one of gamma, amplitude, frequency; defaults gamma, frequency
///   count = round(area_fraction side^2 / A) a missing one of count, area_fraction, side;  defaults side, area_fraction
///   beads                                   from length, end_diameter and bead_pitch
///   time.step                               from accuracy
///   smoothing, grid                         from length
std::optional<RunPlan> resolve(const Draft& draft, std::vector<Problem>& problems);

}  // namespace shaken::scene
