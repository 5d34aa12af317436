// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bench/accuracy/fits.h"
#include "bench/accuracy/start_case.h"
#include "bench/report.h"
#include "sim/world.h"

namespace shaken::bench {

enum class Norm { kPosition, kDirector, kEnergy };
inline constexpr int kNorms = 3;
inline constexpr std::array<const char*, kNorms> kNormNames{"position", "director", "energy"};
inline constexpr std::array<const char*, kNorms> kNormUnits{"mm", "rad", "1"};

/// How far two states of the same rods at the same time are apart, by Norm: root mean square over the rods of the
/// distance of their unwrapped centres [mm] and of the angle between their directors [rad]; difference of the kinetic
/// energies over that of `truth`.
using Errors = std::array<double, kNorms>;
Errors errors_between(const World& state, const World& truth);

/// How to measure convergence.
struct ConvergenceEffort {
  std::vector<double> steps;   ///< rising; kLongestStep over powers of 2 [s]
  int converged_by = 64;       ///< the converged solution's step is the finest of `steps` over this
  std::optional<int> members;  ///< of every ensemble; none: as many as the case says
  int timed_members = 4;       ///< by the reference stepper, to be timed and compared
};

/// What was measured at one step over the ensemble.
struct StepErrors {
  double dt = 0;                         ///< [s]
  std::array<Quartiles, kNorms> errors;  ///< against the converged solution, over the members
  double scheduled_cpu = 0;              ///< CPU time of one member, by the scheduled stepper [s]
  double reference_cpu = 0;              ///< by the reference stepper [s]
  bool states_equal = true;              ///< of the two, bitwise
  int in_trouble = 0;                    ///< members that ended in numerical trouble: not in `errors`
};

/// Errors of one case and variant against the step.
struct Convergence {
  const StartCase* start = nullptr;
  const Variant* variant = nullptr;
  int members = 0;
  double converged_dt = 0;              ///< of the converged solution [s]
  double impulses = 0;                  ///< in the converged solution, per member
  std::array<Quartiles, kNorms> floor;  ///< distance of the converged solution from one of twice its step
  /// Of another variant than the first: distance of its converged solution from the first one's.
  std::optional<std::array<Quartiles, kNorms>> from_first;
  std::vector<StepErrors> steps;                       ///< rising dt
  std::array<std::optional<OrderFit>, kNorms> orders;  ///< of the median
};

Convergence measure_convergence(const StartCase& start, const Variant& variant, const ConvergenceEffort& effort);

Report convergence_report(const std::vector<Convergence>& measured);

}  // namespace shaken::bench
