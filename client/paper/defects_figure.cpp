// SPDX-License-Identifier: MIT
// A locally ordered system: its defects in a picture, their number, how fast they move.
#include "client/paper/figures.h"

namespace shaken::client {

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
  sheet.panels.push_back(
      {.x_title = "speed of a core (mm/s)",
       .y_title = "density (s/mm)",
       .commands = {"set xrange [0:*]", "set yrange [0:*]"},
       .curves = bare(together(
           {{array_curve(runs, "/defects/tracks/speed_mm_s", "/defects/tracks/speed_density_plus", "charge +1/2", 0)},
            {array_curve(runs, "/defects/tracks/speed_mm_s", "/defects/tracks/speed_density_minus", "charge −1/2",
                         1)}})),
       .title = "(c) speeds of long-lived defects"});
  sheet.panels.push_back({.x_title = "distance r (mm)",
                          .y_title = "G_2(r)",
                          .commands = {"set xrange [0:*]", level_line(0)},
                          .curves = bare({array_curve(runs, "/g2/r_mm", "/g2/g2", "", 0)}),
                          .title = "(d) order here and there, none over all"});
  return sheet;
}

}  // namespace shaken::client
