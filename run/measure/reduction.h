#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>

#include "analysis/defect_series.h"
#include "analysis/time_series.h"
#include "run/files/observables_file.h"

namespace shaken::run {

/// A number that a run comes down to.
struct Scalar : Estimate {
  /// Why there is no value, where it takes a word: a system too small, a run too short.
  std::string reason = {};
  /// The time over which it is taken, where its value depends on that [s] (Output::over).
  double over = std::numeric_limits<double>::quiet_NaN();
};

/// What the measurements say of the run as a whole.
struct Reduction {
  Observables arrays;
  std::map<std::string, Scalar> scalars;  ///< by name, which ends in the unit: "theta_m_deg"
  double t_steady = 0;                    ///< as given, as found from S(t), or half the run where neither is there [s]
  std::optional<analysis::SteadySummary> order;
  std::optional<analysis::DefectSeries::MeanCounts> defects;
};

}  // namespace shaken::run
