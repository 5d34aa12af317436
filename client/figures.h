// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "client/figure.h"
#include "client/results.h"
#include "run/files/observables_file.h"

namespace shaken::client {

/// One run that is to be plotted.
struct PlottedRun {
  std::string label;             ///< its swept parameters
  run::Observables observables;  ///< as read from observables.h5
};

/// A figure for each observable that at least one run has: S(t), P(theta), the tilt curve, defects, G2, MSD.
std::vector<Figure> run_figures(const std::vector<PlottedRun>& runs);

/// S against the swept parameter with the most values, from aggregated rows: one curve for each combination of the
/// other swept parameters, bars of one standard error, and a line at S = 0.5. None if no numeric parameter is swept or
/// no point has a result.
std::vector<Figure> sweep_figures(const std::vector<ResultRow>& points);

/// A parameter's name and unit for an axis, in gnuplot's enhanced text: "rod length l (mm)".
std::string axis_title(const std::string& path);

}  // namespace shaken::client
