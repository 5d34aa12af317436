// SPDX-License-Identifier: MIT
// theta_m, lambda and order of the layers against packing, rod length and end diameter.
#include <fmt/format.h>

#include <algorithm>

#include "client/paper/figures.h"

namespace shaken::client {
namespace {

/// Those of the runs that share the value of `common` for which `key` was run at most values; of several the largest.
RunSet with_most_values(const RunSet& runs, const std::string& common, const std::string& key) {
  RunSet best;
  std::size_t most = 0;
  for (const double value : values_of(runs, common)) {
    RunSet here = where(runs, common, value);
    const std::size_t n = values_of(here, key).size();
    if (n >= most) best = std::move(here);
    most = std::max(most, n);
  }
  return best;
}

/// Runs that differ in `key` alone: with thinnest ends otherwise, at the length and the packing at which most values of
/// the key were run.
RunSet along(const RunSet& all, const std::string& key) {
  RunSet runs = key == "rods.end_diameter" ? all : with_extreme(all, "rods.end_diameter", false);
  for (const char* common : {"rods.length", "rods.area_fraction"}) {
    if (key != common) runs = with_most_values(runs, common, key);
  }
  return runs;
}

/// The same places on the axis in every row, also where few runs have layers.
std::string range_of(const std::vector<double>& values) {
  if (values.size() < 2) return "";
  const double margin = 0.1 * (values.back() - values.front());
  return fmt::format("set xrange [{}:{}]", values.front() - margin, values.back() + margin);
}

/// A scalar against a key; beside the angle that is fitted, that of the maximum of P(theta).
std::vector<Curve> trend_curves(const RunSet& runs, const std::string& key, const std::string& scalar) {
  if (scalar != "theta_m_deg") return {scalar_curve(runs, key, scalar, "", 0)};
  return together(
      {{scalar_curve(runs, key, scalar, "fitted", 0)}, {scalar_curve(runs, key, "theta_m_maximum_deg", "maximum", 1)}});
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
      sheet.panels.push_back({.x_title = axis_of(key),
                              .y_title = row.title,
                              .style = Figure::Style::kLinesPoints,
                              .commands = {"set yrange [0:*]", "set offsets graph 0.08, graph 0.08, graph 0.1, 0",
                                           range_of(values_of(runs, key))},
                              .curves = trend_curves(row.of_layers_only ? layered(runs) : runs, key, row.scalar),
                              .title = std::string("(") + letter++ + ")"});
    }
  }
  return sheet;
}

}  // namespace shaken::client
