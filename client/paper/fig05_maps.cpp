// SPDX-License-Identifier: MIT
// G2 and g in the director's frame: maps, and cuts along and across.
#include "client/paper/figures.h"

namespace shaken::client {
namespace {

/// Cuts through the map of "g2" or "g", along the director and across it.
Figure cuts_panel(const RunSet& runs, const std::string& what, std::string y_title, std::string title) {
  const auto cut = [&](const std::string& way) {
    const std::string array = "/pairs/cut/" + what + "_" + way;
    return std::vector<Curve>{array_curve(runs, "/pairs/cut/r_mm", array, way, 0, array + "_sem")};
  };
  return {.x_title = "distance (mm)",
          .y_title = std::move(y_title),
          .commands = {"set xrange [0:*]", level_line(what == "g" ? 1 : 0)},
          .curves = together({cut("along"), cut("across")}),
          .title = std::move(title)};
}

}  // namespace

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
  sheet.panels.push_back(cuts_panel(runs, "g2", "G_2", "(c) cuts through (a)"));
  sheet.panels.push_back(cuts_panel(runs, "g", "g", "(d) cuts through (b)"));
  // where there is no order there is no along and across
  const RunSet dilute =
      with_extreme(with_extreme(material.runs["size"], "rods.area_fraction", false), "box.side", true);
  if (dilute.empty()) return sheet;
  const std::string at = value_label("rods.area_fraction", dilute.front().number("rods.area_fraction"));
  sheet.panels.push_back(cuts_panel(dilute, "g2", "G_2", "(e) cuts at " + at));
  sheet.panels.push_back(cuts_panel(dilute, "g", "g", "(f) cuts at " + at));
  return sheet;
}

}  // namespace shaken::client
