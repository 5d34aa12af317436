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

Sheet defects_figure(const Material& material) {
  const RunSet& runs = material.runs["defects"];
  Sheet sheet{.title = "Defects of a locally ordered system"};
  const std::string point = runs.empty()
                                ? ""
                                : value_label("rods.length", runs.front().number("rods.length")) + ", " +
                                      value_label("rods.area_fraction", runs.front().number("rods.area_fraction"));
  sheet.panels.push_back(snapshot_panel(material, runs, "(a) " + point));
  sheet.panels.push_back({.x_title = "time t (s)",
                          .y_title = "defects of charge +1/2",
                          .commands = {"set xrange [0:*]", "set yrange [0:*]"},
                          .curves = bare({array_curve(runs, "/defects/time_s", "/defects/n_plus", "", 0)}),
                          .title = "(b) number, equal to that of charge −1/2"});
  sheet.panels.push_back(defect_speed_panel(runs, "(c) speeds of defects that last"));
  sheet.panels.push_back({.x_title = "distance r (mm)",
                          .y_title = "G_2(r)",
                          .commands = {"set xrange [0:*]", level_line(0)},
                          .curves = bare({array_curve(runs, "/g2/r_mm", "/g2/g2", "", 0)}),
                          .title = "(d) orientational correlation"});
  return sheet;
}

}  // namespace shaken::client
