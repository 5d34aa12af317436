// SPDX-License-Identifier: MIT
// G2(r) and g(r) of the shortest and the longest rods, at each packing.
#include "client/paper/figures.h"

namespace shaken::client {

Sheet correlation_figure(const Material& material) {
  const RunSet& runs = material.runs["phases"];
  const std::vector<double> lengths = values_of(runs, "rods.length");
  Sheet sheet{.title = "Correlations in space"};
  char letter = 'a';
  for (const char* what : {"g2", "g"}) {
    for (std::size_t end = 0; end < 2 && !lengths.empty(); ++end) {
      const double length = end == 0 ? lengths.front() : lengths.back();
      const bool is_g2 = std::string_view(what) == "g2";
      sheet.panels.push_back({.x_title = "distance r (mm)",
                              .y_title = is_g2 ? "G_2(r) = ⟨cos 2({/Symbol q}_i − {/Symbol q}_j)⟩" : "g(r)",
                              .commands = {"set xrange [0:*]", level_line(is_g2 ? 0 : 1)},
                              .curves = bare(array_curves(where(runs, "rods.length", length), "rods.area_fraction",
                                                          "/g2/r_mm", std::string("/g2/") + what)),
                              .title = std::string("(") + letter++ + ") " + value_label("rods.length", length)});
    }
  }
  return sheet;
}

}  // namespace shaken::client
