// SPDX-License-Identifier: MIT
// Velocity against tilt, the distribution of tilts, and single rods on their way.
#include <fmt/format.h>

#include "client/paper/figures.h"

namespace shaken::client {

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
                          .commands = {"set xrange [*:*] noextend"},
                          .curves = bare({array_curve(first, "/rods/trace/time_s", "/rods/trace/0/n_z", "", 0)}),
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
         .commands = {"set size ratio -1"},
         .curves = bare(std::move(traces)),
         .title = std::string("(") + letter++ + ") paths, " + value_label("rods.area_fraction", fraction)});
  }
  return sheet;
}

}  // namespace shaken::client
