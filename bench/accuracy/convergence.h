// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bench/accuracy/errors.h"
#include "bench/accuracy/order_fit.h"
#include "bench/accuracy/quartiles.h"
#include "bench/accuracy/start_case.h"

namespace shaken::bench {

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

  double simulated() const { return start->duration; }
};

Convergence measure_convergence(const StartCase& start, const Variant& variant, const ConvergenceEffort& effort);

}  // namespace shaken::bench
