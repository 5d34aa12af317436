// SPDX-License-Identifier: MIT
// P[S] at each packing, its width, the Binder cumulant.
#include "client/paper/figures.h"

namespace shaken::client {

Sheet order_statistics_figure(const Material& material) {
  const RunSet& runs = material.runs["phases"];
  const std::vector<double> lengths = values_of(runs, "rods.length");
  const RunSet longest = lengths.empty() ? RunSet{} : where(runs, "rods.length", lengths.back());
  Sheet sheet{.title = "Statistics of the order"};
  sheet.panels.push_back(
      {.x_title = "nematic order S",
       .y_title = "P[S]",
       .commands = {"set xrange [0:1]", "set yrange [0:*]"},
       .curves = array_curves(longest, "rods.area_fraction", "/order/pdf/order", "/order/pdf/density"),
       .title = "(a) longest rods"});
  sheet.panels.push_back({.x_title = axis_of("rods.area_fraction"),
                          .y_title = "Binder cumulant 2 − ⟨S^4⟩/⟨S^2⟩^2",
                          .style = Figure::Style::kLinesPoints,
                          .commands = {"set yrange [-0.2:1.1]", level_line(0), level_line(1)},
                          .curves = scalar_curves(runs, "rods.length", "rods.area_fraction", "binder"),
                          .title = "(b) 0 in disorder, 1 in order"});
  return sheet;
}

}  // namespace shaken::client
