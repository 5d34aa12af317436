// SPDX-License-Identifier: MIT
// Velocity against tilt, the distribution of tilts, and single rods on their way.
#include <fmt/format.h>

#include <algorithm>

#include "client/paper/figures.h"

namespace shaken::client {
namespace {

/// As much of a trace as can be seen in print: the first two seconds.
Curve beginning(Curve trace) {
  std::size_t n = 0;
  while (n < trace.x.size() && trace.x[n] < trace.x.front() + 2.0) ++n;
  trace.x.resize(n);
  trace.y.resize(n);
  return trace;
}

/// The same scale for both axes, with all curves inside.
std::vector<std::string> square_ranges(const std::vector<Curve>& curves) {
  double low[2] = {0, 0}, high[2] = {0, 0};
  for (const Curve& curve : curves) {
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      const double place[2] = {curve.x[k], curve.y[k]};
      for (int axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], place[axis]);
        high[axis] = std::max(high[axis], place[axis]);
      }
    }
  }
  const double half = 0.55 * std::max({high[0] - low[0], high[1] - low[1], 1e-6});
  std::vector<std::string> commands{"set size ratio 1"};
  for (int axis = 0; axis < 2; ++axis) {
    const double middle = (low[axis] + high[axis]) / 2;
    commands.push_back(fmt::format("set {}range [{}:{}]", axis == 0 ? 'x' : 'y', middle - half, middle + half));
  }
  return commands;
}

}  // namespace

Sheet mechanism_figure(const Material& material) {
  const RunSet& all = material.runs["mechanism"];
  const std::vector<double> fractions = values_of(all, "rods.area_fraction");
  const RunSet first = fractions.empty() ? RunSet{} : where(all, "rods.area_fraction", fractions.front());
  Sheet sheet{.title = "How a rod swims", .columns = 3};
  const std::string point = fractions.empty() ? "" : ", " + value_label("rods.area_fraction", fractions.front());
  const std::vector<std::string> axes{"set xzeroaxis linecolor '#999999'", "set yzeroaxis linecolor '#999999'"};
  sheet.panels.push_back(
      {.x_title = "tilt n_z",
       .y_title = "⟨v^n⟩ along the rod (mm/s)",
       .style = Figure::Style::kLinesPoints,
       .commands = axes,
       .curves = {array_curve(first, "/tilt/n_z", "/tilt/v_along_mm_s", "", 0, "/tilt/v_along_sem_mm_s")},
       .title = "(a) velocity along the rod" + point});
  sheet.panels.push_back(
      {.x_title = "tilt n_z",
       .y_title = "⟨v^t⟩ across the rod (mm/s)",
       .style = Figure::Style::kLinesPoints,
       .commands = axes,
       .curves = {array_curve(first, "/tilt/n_z", "/tilt/v_across_mm_s", "", 0, "/tilt/v_across_sem_mm_s")},
       .title = "(b) velocity across the rod" + point});
  sheet.panels.push_back({.x_title = "tilt n_z",
                          .y_title = "P(n_z)",
                          .commands = {"set yrange [0:*]"},
                          .curves = bare(array_curves(all, "rods.area_fraction", "/tilt/n_z", "/tilt/density")),
                          .title = "(c) how often a tilt occurs"});
  sheet.panels.push_back({.x_title = "time t (s)",
                          .y_title = "tilt n_z",
                          .commands = {"set xrange [*:*] noextend", "set yrange [-0.4:0.4]"},
                          .curves = {beginning(array_curve(first, "/rods/trace/time_s", "/rods/trace/0/n_z", "", 0))},
                          .title = "(d) tilt of one rod" + point});
  char letter = 'e';
  for (const double fraction : fractions) {
    if (fraction == fractions.front() && fractions.size() > 2) continue;  // the paper shows the denser two
    const RunSet runs = where(all, "rods.area_fraction", fraction);
    std::vector<Curve> traces;
    for (int k = 0;; ++k) {
      Curve trace = array_curve(runs, fmt::format("/rods/trace/{}/x_mm", k), fmt::format("/rods/trace/{}/y_mm", k), "",
                                static_cast<std::size_t>(k));
      if (trace.x.empty()) break;
      // each from where it began
      const double x = trace.x.front(), y = trace.y.front();
      for (double& value : trace.x) value -= x;
      for (double& value : trace.y) value -= y;
      traces.push_back(std::move(trace));
    }
    sheet.panels.push_back(
        {.x_title = "x (mm)",
         .y_title = "y (mm)",
         .commands = square_ranges(traces),
         .curves = bare(std::move(traces)),
         .title = std::string("(") + letter++ + ") paths, " + value_label("rods.area_fraction", fraction)});
  }
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "time (s)",
       .style = Figure::Style::kLinesPoints,
       .commands = {"set yrange [0:*]"},
       .curves =
           together({{scalar_curve(all, "rods.area_fraction", "persistence_time_s", "a way persists", 0)},
                     {scalar_curve(all, "rods.area_fraction", "n_z_switching_time_s", "a tilt keeps its sign", 1)}}),
       .title = std::string("(") + letter + ") how long rods keep their way"});
  return sheet;
}

}  // namespace shaken::client
