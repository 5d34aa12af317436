// SPDX-License-Identifier: MIT
// theta_m, lambda and order of the layers against packing, rod length and end diameter.
#include <fmt/format.h>

#include "client/paper/figures.h"

namespace shaken::client {
namespace {

/// The runs that differ from the reference (longest rods, thinnest ends, packing 0.80 or what there is) in `key` alone.
RunSet along(const RunSet& all, const std::string& key) {
  RunSet runs = all;
  if (key != "rods.end_diameter") runs = with_extreme(runs, "rods.end_diameter", false);
  if (key != "rods.length") runs = with_extreme(runs, "rods.length", true);
  if (key != "rods.area_fraction" && !runs.empty()) {
    // the packing at which most values of the key were run
    RunSet best;
    for (const double fraction : values_of(runs, "rods.area_fraction")) {
      const RunSet here = where(runs, "rods.area_fraction", fraction);
      if (here.size() >= best.size()) best = here;
    }
    runs = best;
  }
  return runs;
}

/// The same places on the axis in every row, also where few runs have layers.
std::string range_of(const std::vector<double>& values) {
  if (values.size() < 2) return "";
  const double margin = 0.1 * (values.back() - values.front());
  return fmt::format("set xrange [{}:{}]", values.front() - margin, values.back() + margin);
}

}  // namespace

Sheet layer_trends_figure(const Material& material) {
  const RunSet& all = material.runs["layers"];
  Sheet sheet{.title = "Angle and wavelength of the layers", .columns = 3};
  char letter = 'a';
  const struct {
    const char* scalar;
    const char* title;
    bool of_layers_only;
  } rows[] = {{"theta_m_deg", "{/Symbol q}_m (degrees)", true},
              {"wavelength_mm", "wavelength {/Symbol l} (mm)", true},
              {"layer_order", "order of the layers", false}};
  for (const auto& row : rows) {
    for (const char* key : {"rods.area_fraction", "rods.length", "rods.end_diameter"}) {
      const RunSet runs = along(all, key);
      sheet.panels.push_back(
          {.x_title = axis_of(key),
           .y_title = row.title,
           .style = Figure::Style::kLinesPoints,
           .commands = {"set yrange [0:*]", "set offsets graph 0.08, graph 0.08, graph 0.1, 0",
                        range_of(values_of(runs, key))},
           .curves = {scalar_curve(row.of_layers_only ? layered(runs) : runs, key, row.scalar, "", 0)},
           .title = std::string("(") + letter++ + ")"});
    }
  }
  return sheet;
}

}  // namespace shaken::client
