// SPDX-License-Identifier: MIT
// The layered phase: pictures, P(theta), and what oscillates across the director.
#include "client/paper/figures.h"

namespace shaken::client {
Sheet layers_figure(const Material& material) {
  const RunSet runs =
      with_extreme(with_extreme(material.runs["layers"], "rods.length", true), "rods.end_diameter", false);
  Sheet sheet{.title = "The layered phase", .columns = 3};
  char letter = 'a';
  for (const double fraction : values_of(runs, "rods.area_fraction")) {
    sheet.panels.push_back(
        snapshot_panel(material, where(runs, "rods.area_fraction", fraction),
                       std::string("(") + letter++ + ") " + value_label("rods.area_fraction", fraction)));
  }
  while (sheet.panels.size() % 3 != 0) sheet.panels.push_back(empty_panel());
  sheet.panels.push_back(
      {.x_title = "angle to the director {/Symbol q} (rad)",
       .y_title = "P({/Symbol q}) (1/rad)",
       .commands = {"set xrange [-0.8:0.8]", "set yrange [0:*]"},
       .curves = bare(array_curves(runs, "rods.area_fraction", "/angles/theta_rad", "/angles/density_per_rad")),
       .title = std::string("(") + letter++ + ") distribution of angles"});
  sheet.panels.push_back(
      {.x_title = "distance across the director (mm)",
       .y_title = "G_2",
       .commands = {"set xrange [0:*]"},
       .curves = bare(array_curves(runs, "rods.area_fraction", "/pairs/cut/r_mm", "/pairs/cut/g2_across")),
       .title = std::string("(") + letter++ + ") G_2 across the director"});
  sheet.panels.push_back({.x_title = "wave number across the director (1/mm)",
                          .y_title = "spectrum of sin 2({/Symbol q} − {/Symbol q}_N)",
                          .commands = {"set xrange [0:2]", "set logscale y"},
                          .curves = positive(bare(
                              array_curves(runs, "rods.area_fraction", "/layers/q_per_mm", "/layers/spectrum_across"))),
                          .title = std::string("(") + letter++ + ") structure factor of the angles"});
  return sheet;
}

}  // namespace shaken::client
