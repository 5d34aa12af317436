// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/figure.h"
#include "study/run_set.h"

namespace shaken::study {

/// The shortest and the longest rods of a set, and how titles call them: ", l = 2.5 mm".
struct BothLengths {
  explicit BothLengths(const RunSet& runs);
  RunSet shortest, longest;
  std::string of_short, of_long;
};

/// What a figure is drawn from.
struct Material {
  const Library& runs;
  /// A picture of a run's last recorded frame; an empty path if it has none or cannot be drawn.
  std::function<std::filesystem::path(const FinishedRun&)> snapshot;
};

/// Arrays "x" and "y" of replicas, averaged where they have the same x; empty if no run has them. `sem` names the array
/// of each run's own errors, where it has one; the error of several runs is that of client::replica_mean(). Of long
/// curves without errors, S(t) for one, every k-th point is kept: some 600.
Curve array_curve(const RunSet& replicas, const std::string& x, const std::string& y, std::string label,
                  std::size_t colour, const std::string& sem = "");

/// A scalar against a key of the scene: one point per value of the key, averaged over replicas, with error bars; the
/// error is NaN where it is not known, and then has no bar. Points of runs that still relax are hollow.
Curve scalar_curve(const RunSet& runs, const std::string& key, const std::string& scalar, std::string label,
                   std::size_t colour);

/// One curve of arrays for each value of a key, labelled with it: "φ = 0.65".
std::vector<Curve> array_curves(const RunSet& runs, const std::string& key, const std::string& x, const std::string& y,
                                const std::string& sem = "");
/// One curve of a scalar against `key` for each value of `series`.
std::vector<Curve> scalar_curves(const RunSet& runs, const std::string& series, const std::string& key,
                                 const std::string& scalar);

/// "φ = 0.65", "ℓ = 4.5 mm".
std::string value_label(const std::string& key, double value);
/// That of the first of `runs` (one or more).
std::string label_of(const RunSet& runs, const std::string& key);

/// A law or a fit, dashed, at `n` places from `from` to `to`.
Curve law_curve(const std::function<double(double)>& law, double from, double to, std::string label, std::size_t colour,
                int n = 80);

/// Only points with positive x and y, for logarithmic axes.
std::vector<Curve> positive(std::vector<Curve> curves);
/// Without error bars, where many curves would hide each other.
std::vector<Curve> bare(std::vector<Curve> curves);
/// All together, coloured one after the other.
std::vector<Curve> together(std::vector<std::vector<Curve>> groups);

/// A map stored flattened beside its two axes.
Map map_of(const FinishedRun& run, const std::string& x, const std::string& y, const std::string& z, bool diverging);

/// A picture of the run under a title; says so where there is none.
Figure snapshot_panel(const Material& material, const RunSet& runs, std::string title);

/// Fills the last row of a sheet with places that stay empty.
void fill_row(Sheet& sheet);

/// The letters of a sheet's panels: "(a) ", "(b) ", ... before their titles, one after the other.
class Letters {
 public:
  std::string operator()(const std::string& title) {
    return std::string("(") + next_++ + ")" + (title.empty() ? "" : " " + title);
  }

 private:
  char next_ = 'a';
};

/// Curves of numbers against a key of the scene: points joined by lines.
Figure key_panel(const std::string& key, std::string y_title, std::vector<Curve> curves, std::string title,
                 std::vector<std::string> commands = {"set yrange [0:*]"});
/// S(t) from the aligned start, one curve for each packing.
Figure start_panel(const RunSet& runs, std::string title);
/// P(theta), one curve for each value of `key`.
Figure angles_panel(const RunSet& runs, const std::string& key, std::string title);
/// "g2" or "g" against the distance, one curve for each packing.
Figure distance_panel(const RunSet& runs, const std::string& what, std::string y_title, std::string title);
/// G2 across the director, one curve for each value of `key`.
Figure g2_across_panel(const RunSet& runs, const std::string& key, std::string title);

/// Sharma & Soni's fit to the diffusion constant of 2.5 mm rods [mm^2/s] against the area fraction, above 0.6.
double papers_diffusion(double area_fraction);

/// The area fraction at which <S> passes 0.5, as the paper draws the line.
Estimate transition(const RunSet& runs);
/// That area fraction for each value of `key` at which there is one.
std::vector<Point> transitions(const RunSet& runs, const std::string& key);

/// Standard deviation of S(t) over the samples of replicas, sqrt(susceptibility / N): of samples as they were taken,
/// however long the run. NaN if not measured.
double order_spread(const RunSet& replicas);

/// The run with the most defects per area; none of none.
RunSet with_most_defects(const RunSet& runs);

/// The title of an axis that shows a key of the scene.
std::string axis_of(const std::string& key);

/// gnuplot: a thin line at y over the whole plot.
std::string level_line(double y);

}  // namespace shaken::study
