// SPDX-License-Identifier: MIT
// A locally ordered system: its defects in a picture, their number, how fast they move.
#include "client/paper/figures.h"

namespace shaken::client {

Figure defect_speed_panel(const RunSet& runs, std::string title) {
  const auto curve = [&](const std::string& name, std::string label) {
    return array_curve(runs, "/defects/tracks/span_s", "/defects/tracks/lasting/" + name + "_mm_s", std::move(label), 0,
                       "/defects/tracks/lasting/" + name + "_sem_mm_s");
  };
  return {.x_title = "time over which a core's way is taken (s)",
          .y_title = "mean speed (mm/s)",
          .style = Figure::Style::kLinesPoints,
          .commands = {"set logscale x 2", "set xzeroaxis linecolor '#999999'"},
          .curves = together({{curve("speed_plus", "charge +1/2")},
                              {curve("speed_minus", "charge −1/2")},
                              {curve("speed_plus_along", "+1/2, towards its tail")}}),
          .title = std::move(title)};
}

RunSet with_most_defects(const RunSet& runs) {
  RunSet most;
  for (const FinishedRun& run : runs) {
    const double density = run.scalar("defect_density_per_mm2").value;
    if (most.empty() || density > most.front().scalar("defect_density_per_mm2").value) most = {run};
  }
  return most;
}

Sheet defects_figure(const Material& material) {
  const RunSet& runs = material.runs["defects"];
  Sheet sheet{.title = "Defects of systems that are ordered here and there", .columns = 3};
  char letter = 'a';
  for (const double length : values_of(runs, "rods.length")) {
    const RunSet here = where(runs, "rods.length", length);
    sheet.panels.push_back(
        snapshot_panel(material, here,
                       std::string("(") + letter++ + ") " + value_label("rods.length", length) + ", " +
                           value_label("rods.area_fraction", here.front().number("rods.area_fraction"))));
  }
  sheet.panels.push_back({.x_title = "time t (s)",
                          .y_title = "defects of charge +1/2",
                          .commands = {"set xrange [0:*]", "set yrange [0:*]"},
                          .curves = bare(array_curves(runs, "rods.length", "/defects/time_s", "/defects/n_plus")),
                          .title = std::string("(") + letter++ + ") number, equal to that of charge −1/2"});
  sheet.panels.push_back(defect_speed_panel(
      with_most_defects(runs), std::string("(") + letter++ + ") speeds of those that last, where there are most"));
  sheet.panels.push_back({.x_title = "distance r (mm)",
                          .y_title = "G_2(r)",
                          .commands = {"set xrange [0:*]", "set yrange [*<0:*]", level_line(0)},
                          .curves = bare(array_curves(runs, "rods.length", "/g2/r_mm", "/g2/g2")),
                          .title = std::string("(") + letter++ + ") orientational correlation"});
  return sheet;
}

}  // namespace shaken::client
