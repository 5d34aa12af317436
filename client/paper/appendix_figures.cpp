// SPDX-License-Identifier: MIT
// The paper's appendices: a larger box, other gaps, the way to the steady state.
#include "client/paper/figures.h"

namespace shaken::client {
namespace {

/// The state point that the appendices vary: longest rods, thinnest ends, the packing in the middle.
RunSet layered_point(const RunSet& all) {
  const RunSet runs = with_extreme(with_extreme(all, "rods.length", true), "rods.end_diameter", false);
  const std::vector<double> fractions = values_of(runs, "rods.area_fraction");
  return fractions.empty() ? runs : where(runs, "rods.area_fraction", fractions[fractions.size() / 2]);
}

}  // namespace

Sheet larger_box_figure(const Material& material) {
  const RunSet& large = material.runs["large"];
  const RunSet small =
      large.empty() ? layered_point(material.runs["layers"]) : at_point_of(material.runs["layers"], large.front());
  const RunSet both = joined(small, large);
  Sheet sheet{.title = "The layers in a larger box"};
  sheet.panels.push_back(snapshot_panel(material, small, "(a) smaller box"));
  sheet.panels.push_back(snapshot_panel(material, large, "(b) larger box"));
  sheet.panels.push_back(
      {.x_title = "angle to the director {/Symbol q} (rad)",
       .y_title = "P({/Symbol q}) (1/rad)",
       .commands = {"set xrange [-0.8:0.8]", "set yrange [0:*]"},
       .curves = bare(array_curves(both, "box.side", "/angles/theta_rad", "/angles/density_per_rad")),
       .title = "(c) distribution of angles"});
  sheet.panels.push_back({.x_title = "distance across the director (mm)",
                          .y_title = "G_2",
                          .commands = {"set xrange [0:*]"},
                          .curves = bare(array_curves(both, "box.side", "/pairs/cut/r_mm", "/pairs/cut/g2_across")),
                          .title = "(d) G_2 across the director"});
  return sheet;
}

Sheet gap_figure(const Material& material) {
  const RunSet both = joined(layered_point(material.runs["layers"]), material.runs["gaps"]);
  Sheet sheet{.title = "The gap between the plates", .columns = 3};
  char letter = 'a';
  for (const double gap : values_of(both, "box.gap")) {
    sheet.panels.push_back(snapshot_panel(material, where(both, "box.gap", gap),
                                          std::string("(") + letter++ + ") " + value_label("box.gap", gap)));
  }
  while (sheet.panels.size() % 3 != 0) sheet.panels.push_back(empty_panel());
  sheet.panels.push_back({.x_title = "angle to the director {/Symbol q} (rad)",
                          .y_title = "P({/Symbol q}) (1/rad)",
                          .commands = {"set xrange [-0.8:0.8]", "set yrange [0:*]"},
                          .curves = bare(array_curves(both, "box.gap", "/angles/theta_rad", "/angles/density_per_rad")),
                          .title = std::string("(") + letter++ + ") distribution of angles"});
  sheet.panels.push_back({.x_title = "distance r (mm)",
                          .y_title = "g(r)",
                          .commands = {"set xrange [0:*]", level_line(1)},
                          .curves = bare(array_curves(both, "box.gap", "/g2/r_mm", "/g2/g")),
                          .title = std::string("(") + letter++ + ") distances"});
  sheet.panels.push_back({.x_title = axis_of("box.gap"),
                          .y_title = "crystal measure, {/Symbol y}_6",
                          .style = Figure::Style::kLinesPoints,
                          .commands = {"set yrange [0:*]"},
                          .curves = together({{scalar_curve(both, "box.gap", "bragg_peak", "Bragg peak", 0)},
                                              {scalar_curve(both, "box.gap", "psi_6", "ψ6", 1)}}),
                          .title = std::string("(") + letter++ + ") crystal"});
  return sheet;
}

Sheet steady_state_figure(const Material& material) {
  const double length = 3.5;
  const RunSet small = where(material.runs["phases"], "rods.length", length);
  const RunSet longer = where(material.runs["layers"], "rods.length", length);
  Sheet sheet{.title = "On the way to the steady state, l = 3.5 mm"};
  sheet.panels.push_back({.x_title = "time t (s)",
                          .y_title = "nematic order S",
                          .commands = {"set xrange [0:*]", "set yrange [0:1]"},
                          .curves = array_curves(with_extreme(small, "time.seed", false), "rods.area_fraction",
                                                 "/order/time_s", "/order/order"),
                          .title = "(a) from the aligned start"});
  sheet.panels.push_back({.x_title = "time t (s)",
                          .y_title = "S; director's angle / 90°",
                          .commands = {"set xrange [0:*]"},
                          .curves = together({{array_curve(longer, "/order/time_s", "/order/order", "S", 0)}, {[&] {
                                                Curve angle = array_curve(longer, "/order/time_s",
                                                                          "/order/director_rad", "director", 1);
                                                for (double& value : angle.y) value /= 1.5707963267948966;
                                                return angle;
                                              }()}}),
                          .title = "(b) larger box, area fraction 0.85: order and where it points"});
  return sheet;
}

}  // namespace shaken::client
