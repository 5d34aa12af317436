// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/figure.h"
#include "client/results.h"
#include "run/files/observables_file.h"

namespace shaken::client {

/// One run that is to be plotted.
struct PlottedRun {
  std::string point;                            ///< its swept parameters, the same for all replicas
  run::Observables observables;                 ///< as read from observables.h5
  Steadiness steadiness = Steadiness::kSteady;  ///< of the state that its averages are from
  RowVersion version{};                         ///< what computed it
  std::string id{};                             ///< of the run, if it is known
};

/// A figure for each observable that at least one run has and that one curve can show: S(t), P[S], P(theta), the tilt
/// curve, defects, G2 and g, layers, MSD, C_2, C_v, number fluctuations. Replicas by one version share a colour; of
/// what does not depend on time their mean is drawn, with the standard error of replica_mean: as bars at the points of
/// the tilt curve, elsewhere as a band. Points of which one replica still relaxed say so: hollow, or by the curve's
/// label.
std::vector<Figure> run_figures(std::vector<PlottedRun> runs);

/// What sweep_figures draws against what; fields as in ResultRow.
struct SweepAxes {
  std::string x{};  ///< empty: the swept parameter with the most values
  std::string y = "order.mean";
};

/// A number of the results against a swept parameter (or another number), from aggregated rows: one curve for each
/// combination of the other swept parameters and of what computed them, bars of one standard error, points that still
/// relaxed hollow, and for S a line at 0.5. None if no numeric parameter is swept or no point has a result.
std::vector<Figure> sweep_figures(const std::vector<ResultRow>& points, const SweepAxes& axes = {});

/// The mean of curves (one or more) over the same x, with the errors of replica_mean. Points relax if one of the curves
/// says so.
Curve mean_curve(const std::vector<Curve>& replicas);

/// Parameters as they are called in print: "φ = 0.6, ℓ = 2.5 mm".
std::string point_label(const Json& parameters);

/// Name and unit of a parameter, or of a field of the results, for an axis, in gnuplot's enhanced text:
/// "rod length l (mm)".
std::string axis_title(const std::string& path);

}  // namespace shaken::client
