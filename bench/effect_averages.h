// SPDX-License-Identifier: MIT
// What an effect of the physics does to the averages of the steady state: the scene without it against that with
// everything on.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "bench/accuracy/averaged.h"
#include "bench/case.h"
#include "bench/report.h"

namespace shaken::bench {

/// The mean of each observable over time, in the order of kObservables and in their units.
using Averages = std::array<Estimate, kObservables.size()>;

/// Of one run's samples. Errors and steadiness are those of analysis::summarize_series. A value that does not vary at
/// all has the error 0; one of which there is no sample is NaN.
Averages averages_of(const ObservableSeries& series);

/// Goes on for `seconds` of simulated time from the state of the scene after its own warm-up, and averages over them.
/// Throws Failure if the rods cannot be placed, or on numerical trouble.
Averages measure_averages(const Case& scene, const Cache& cache, double seconds);

/// a / b of independent numbers, with its error to first order; NaN where b is 0 or unknown.
Estimate ratio_of(const Estimate& a, const Estimate& b);

/// A row of the report: the means without an effect and, as "relative", their ratios to those of everything on.
Json averages_row(const std::string& without, const std::string& neutral, const Averages& averages,
                  const Averages& everything);
/// "value", "sem" and "steady" of each observable; null: unknown.
Json json_of(const Averages& averages);

/// The rows as a table of ratios in per cent, with the means of everything on above it, and below it all means that are
/// not steady. `report` has "everything" and "rows".
std::string averages_text(const Json& report);

}  // namespace shaken::bench
