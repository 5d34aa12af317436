#pragma once

#include <string>

#include "bench/report.h"
#include "bench/timing.h"
#include "bench/work.h"

namespace shaken::bench {

/// How figures of speed came about.
struct Conditions {
  Effort effort;
  double warm_up = 0;  ///< [s]
  /// Shorter than this, the rods still stand much as they were placed: figures are then not of the steady state.
  static constexpr double kSteady = 5.0;
  bool steady() const { return warm_up >= kSteady; }
};

/// What is compared: both steppers on each scene, or the scheduled one by kind of scene, by the number of rods, by the
/// step, by the number of threads.
enum class Comparison { kSteppers, kKinds, kRods, kStep, kThreads };

/// Rows of what was timed in turn, each relative to the first, with what the scheduled stepper did.
Json rate_row(const Contender& of, const Contender& first, const CountedWork& work);

/// A row of both steppers on one scene. Their states after `compared_ticks` must be the same.
Json steppers_row(const Contender& scheduled, const Contender& reference, const CountedWork& work, Tick compared_ticks,
                  std::uint64_t scheduled_hash);

/// A row of so many threads, which must not change the state. No number of them can exceed the speed-up "limit" if they
/// share all but the serial part of the work evenly (Amdahl 1967).
Json threads_row(const Contender& of, const Contender& first, const CountedWork& work);

/// The rows of a comparison, as files and for people.
Report rates_report(const Conditions& conditions, Comparison of, const Json& rows);

/// Throws Failure, "SCENE: WHAT after 1250 ticks", for the first row in which states that must be equal are not.
void check_states(const Report& report, const std::string& what);

}  // namespace shaken::bench
