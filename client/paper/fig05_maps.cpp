// SPDX-License-Identifier: MIT
// G2 and g in the director's frame: maps, and cuts along and across.
#include "client/paper/figures.h"

namespace shaken::client {

Sheet pair_map_figure(const Material& material) {
  // the state point with the least packing, for it has no layers
  RunSet runs = with_extreme(material.runs["layers"], "rods.end_diameter", false);
  runs = with_extreme(with_extreme(runs, "rods.length", true), "rods.area_fraction", false);
  Sheet sheet{.title = "Correlations along and across the director"};
  if (runs.empty()) return sheet;
  const std::string point = value_label("rods.length", runs.front().number("rods.length")) + ", " +
                            value_label("rods.area_fraction", runs.front().number("rods.area_fraction"));
  sheet.panels.push_back({.x_title = "along the director (mm)",
                          .y_title = "across (mm)",
                          .commands = {"set cbrange [0:1]"},
                          .title = "(a) G_2(x, y), " + point,
                          .map = map_of(runs.front(), "/pairs/along_mm", "/pairs/across_mm", "/pairs/g2", false)});
  sheet.panels.push_back({.x_title = "along the director (mm)",
                          .y_title = "across (mm)",
                          .commands = {"set cbrange [0:2.5]"},
                          .title = "(b) g(x, y), " + point,
                          .map = map_of(runs.front(), "/pairs/along_mm", "/pairs/across_mm", "/pairs/g", false)});
  sheet.panels.push_back(
      {.x_title = "distance (mm)",
       .y_title = "G_2",
       .commands = {"set xrange [0:*]"},
       .curves = bare(together({{array_curve(runs, "/pairs/cut/r_mm", "/pairs/cut/g2_along", "along", 0)},
                                {array_curve(runs, "/pairs/cut/r_mm", "/pairs/cut/g2_across", "across", 1)}})),
       .title = "(c) cuts through (a)"});
  sheet.panels.push_back(
      {.x_title = "distance (mm)",
       .y_title = "g",
       .commands = {"set xrange [0:*]", level_line(1)},
       .curves = bare(together({{array_curve(runs, "/pairs/cut/r_mm", "/pairs/cut/g_along", "along", 0)},
                                {array_curve(runs, "/pairs/cut/r_mm", "/pairs/cut/g_across", "across", 1)}})),
       .title = "(d) cuts through (b)"});
  return sheet;
}

}  // namespace shaken::client
