// How long a run goes on: the part of a plan that its id leaves out.
#pragma once

#include <optional>

#include "base/core/types.h"
#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// Ticks from start to end of the plan; with `until`, at least.
Tick total_ticks(const RunPlan& plan);
/// Ticks from start to end of the plan; with `until`, at most.
Tick most_ticks(const RunPlan& plan);

/// The first tick >= `from` at which the run may end. With `until` these are `time.measure`, and each time a quarter
/// more, up to `until.at_most`: they follow from the plan alone, so that a run that was stopped ends where it would
/// have ended. `from` itself where the run has come further than the plan asks.
Tick next_end(const RunPlan& plan, Tick from);

/// What is known of S, as far as the end of a run depends on it.
struct KnownOrder {
  double sem = 0;              ///< standard error of its mean; NaN: not known
  std::optional<bool> steady;  ///< none: it cannot be told
};

/// Whether a run that has come to `tick` has done what the plan asks. `order` is none if S is not measured.
bool is_long_enough(const RunPlan& plan, Tick tick, const std::optional<KnownOrder>& order);

/// `plan`, going on for as long as both it and `other` ask for: the longer `time.measure`, and of two `until` the
/// smaller error and the later end.
RunPlan as_long_as_both(RunPlan plan, const RunPlan& other);

/// Whether a run of `present`, come to its end, must go on for `wanted`.
bool asks_for_more(const RunPlan& wanted, const RunPlan& present);

}  // namespace shaken::scene
