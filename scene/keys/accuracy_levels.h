#pragma once

#include <span>
#include <string_view>

#include "sim/system.h"

namespace shaken::scene {

/// How far an observable is off at a level, against the limit of a fine step.
struct Bias {
  std::string_view observable;  ///< "order"
  double value = 0;             ///< measured mean difference, in `unit`
  double error = 0;             ///< its standard error
  std::string_view unit;        ///< "%" of the observable's value, or its own unit
};

/// What a word for accuracy stands for.
struct AccuracyLevel {
  std::string_view name;  ///< as in the scene: "paper"
  std::string_view what;  ///< what it is for, one line
  double step = 0;        ///< time.step [s]
  ImpactTime impacts = ImpactTime::kTickEnd;
  /// Bounds on |bias| with two standard errors to spare, for rods of 4.5 and of 2.5 mm [%].
  double averages_within = 0;  ///< of temperatures, tilt and square displacement
  double just_hit_within = 0;  ///< of the share of rods that were just hit
  /// CPU time per simulated second against "paper", as docs/data/accuracy-bias.csv has it.
  double cost = 1;
  std::span<const Bias> bias;
};

/// The levels, from coarse to fine.
std::span<const AccuracyLevel> accuracy_levels();
/// CPU time per simulated second with this step, against "paper": as measured at the levels, and between and beyond the
/// steps of those with impacts at the tick's end on straight lines of log cost against log step.
double relative_cost(double step, ImpactTime impacts);
/// The level of that name; null if there is none.
const AccuracyLevel* accuracy_level(std::string_view name);
/// The level that a system is at; null if it is at none.
const AccuracyLevel* accuracy_level(const System& system);

/// As in the scene: "tick_end", "at_instant".
constexpr const char* name_of(ImpactTime impacts) {
  return impacts == ImpactTime::kAtInstant ? "at_instant" : "tick_end";
}

}  // namespace shaken::scene
