// SPDX-License-Identifier: MIT
// Layers: pictures, P(theta), correlations along and across the director, trends, gaps, a larger box, elasticity.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/figures.h"

namespace shaken::study {
namespace {

/// Cuts through the map of "g2" or "g", along the director and across it.
Figure cuts_panel(const RunSet& runs, const std::string& what, std::string title) {
  const auto cut = [&](const std::string& way) {
    const std::string array = "/pairs/cut/" + what + "_" + way;
    return std::vector<Curve>{array_curve(runs, "/pairs/cut/r_mm", array, way, 0, array + "_sem")};
  };
  return {.x_title = "distance (mm)",
          .y_title = what == "g2" ? "G_2" : "g",
          .commands = {"set xrange [0:*]", level_line(what == "g" ? 1 : 0)},
          .curves = together({cut("along"), cut("across")}),
          .title = std::move(title)};
}

Figure map_panel(const FinishedRun& run, const std::string& what, const char* colours, std::string title) {
  return {.x_title = "along the director (mm)",
          .y_title = "across (mm)",
          .commands = {colours},
          .title = std::move(title),
          .map = map_of(run, "/pairs/along_mm", "/pairs/across_mm", "/pairs/" + what, false)};
}

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
  for (const char* common : {kLength, kPacking}) {
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

/// The state point that the appendices vary: longest rods, thinnest ends, the packing in the middle.
RunSet layered_point(const RunSet& all) {
  const RunSet runs = with_extreme(with_extreme(all, kLength, true), "rods.end_diameter", false);
  const std::vector<double> fractions = values_of(runs, kPacking);
  return fractions.empty() ? runs : where(runs, kPacking, fractions[fractions.size() / 2]);
}

/// Power against wave number, for wave vectors nearly along or nearly across the director.
Curve power_curve(const RunSet& runs, bool along, std::size_t colour) {
  Curve cut{.label = along ? "along: bend" : "across: splay", .colour = colour};
  for (const FinishedRun& run : runs) {
    const auto &q_along = run.array("/frank/q_along_per_mm"), &q_across = run.array("/frank/q_across_per_mm"),
               &power = run.array("/frank/power_mm2");
    for (std::size_t k = 0; k < std::min({q_along.size(), q_across.size(), power.size()}); ++k) {
      const double a = std::abs(q_along[k]), b = std::abs(q_across[k]);
      if ((along ? b : a) > 0.35 * (along ? a : b)) continue;
      cut.x.push_back(std::hypot(a, b));
      cut.y.push_back(power[k]);
    }
  }
  return cut;
}

/// The map of "g2" or "g" of ordered rods without layers, cuts through it, and cuts where there is no order, and so no
/// along and across. Titles are lettered from `letter` on.
std::vector<Figure> along_and_across(const Material& material, const std::string& what, const std::string& of_what,
                                     const char* colours, char letter) {
  // the state point with the least packing of the layered sweep, for it has no layers
  RunSet runs = with_extreme(material.runs["layers"], "rods.end_diameter", false);
  runs = with_extreme(with_extreme(runs, kLength, true), kPacking, false);
  if (runs.empty()) return {};
  const std::string point = label_of(runs, kLength) + ", " + label_of(runs, kPacking);
  const auto lettered = [&](int k, const std::string& title) {
    return fmt::format("({}) {}", static_cast<char>(letter + k), title);
  };
  std::vector<Figure> panels{map_panel(runs.front(), what, colours, lettered(0, of_what + ", " + point)),
                             cuts_panel(runs, what, lettered(1, fmt::format("cuts through ({})", letter)))};
  const RunSet dilute = with_extreme(with_extreme(material.runs["size"], kPacking, false), "box.side", true);
  if (!dilute.empty()) panels.push_back(cuts_panel(dilute, what, lettered(2, "cuts at " + label_of(dilute, kPacking))));
  return panels;
}

}  // namespace

Sheet g2_map_figure(const Material& material) {
  Sheet sheet{.title = "Orientational correlation along and across the director", .columns = 3};
  sheet.panels = along_and_across(material, "g2", "G_2(x, y)", "set cbrange [0:1]", 'a');
  return sheet;
}

Sheet distances_figure(const Material& material) {
  const auto [shortest, longest, of_short, of_long] = BothLengths(material.runs["phases"]);
  Sheet sheet{.title = "Pair correlation", .columns = 3};
  sheet.panels = {distance_panel(shortest, "g", "g(r)", "(a) shortest rods" + of_short),
                  distance_panel(longest, "g", "g(r)", "(b) longest rods" + of_long)};
  fill_row(sheet);
  for (Figure& panel : along_and_across(material, "g", "g(x, y)", "set cbrange [0:2.5]", 'c')) {
    sheet.panels.push_back(std::move(panel));
  }
  return sheet;
}

Sheet layers_figure(const Material& material) {
  const RunSet runs = with_extreme(with_extreme(material.runs["layers"], kLength, true), "rods.end_diameter", false);
  Sheet sheet{.title = "The layered phase", .columns = 3};
  Letters letter;
  for (const double fraction : values_of(runs, kPacking)) {
    sheet.panels.push_back(
        snapshot_panel(material, where(runs, kPacking, fraction), letter(value_label(kPacking, fraction))));
  }
  fill_row(sheet);
  sheet.panels.push_back(angles_panel(runs, kPacking, letter("distribution of angles")));
  sheet.panels.push_back(g2_across_panel(runs, kPacking, letter("G_2 across the director")));
  sheet.panels.push_back(
      {.x_title = "wave number across the director (1/mm)",
       .y_title = "spectrum of sin 2({/Symbol q} − {/Symbol q}_N)",
       .commands = {"set xrange [0:2]", "set logscale y"},
       .curves = positive(bare(array_curves(runs, kPacking, "/layers/q_per_mm", "/layers/spectrum_across"))),
       .title = letter("structure factor of the angles")});
  return sheet;
}

Sheet layer_trends_figure(const Material& material) {
  const RunSet& all = material.runs["layers"];
  Sheet sheet{.title = "Angle and wavelength of the layers", .columns = 3};
  Letters letter;
  const struct {
    const char* scalar;
    const char* title;
    bool of_layers_only;
  } rows[] = {{"theta_m_deg", "{/Symbol q}_m (degrees)", true},
              {"wavelength_mm", "wavelength {/Symbol l} (mm)", true},
              {"layer_order", "order of the layers", false}};
  for (const auto& row : rows) {
    for (const char* key : {kPacking, kLength, "rods.end_diameter"}) {
      const RunSet runs = along(all, key);
      sheet.panels.push_back(key_panel(
          key, row.title, trend_curves(row.of_layers_only ? layered(runs) : runs, key, row.scalar), letter(""),
          {"set yrange [0:*]", "set offsets graph 0.08, graph 0.08, graph 0.1, 0", range_of(values_of(runs, key))}));
    }
  }
  return sheet;
}

Sheet larger_box_figure(const Material& material) {
  const RunSet& large = material.runs["large"];
  const RunSet small =
      large.empty() ? layered_point(material.runs["layers"]) : at_point_of(material.runs["layers"], large.front());
  const RunSet both = joined(small, large);
  return {
      .title = "The layers in a larger box",
      .panels = {snapshot_panel(material, small, "(a) smaller box"), snapshot_panel(material, large, "(b) larger box"),
                 angles_panel(both, "box.side", "(c) distribution of angles"),
                 g2_across_panel(both, "box.side", "(d) G_2 across the director")}};
}

Sheet gap_figure(const Material& material) {
  const RunSet both = joined(layered_point(material.runs["layers"]), material.runs["gaps"]);
  Sheet sheet{.title = "The gap between the plates", .columns = 3};
  Letters letter;
  for (const double gap : values_of(both, "box.gap")) {
    sheet.panels.push_back(snapshot_panel(material, where(both, "box.gap", gap), letter(value_label("box.gap", gap))));
  }
  fill_row(sheet);
  sheet.panels.push_back(angles_panel(both, "box.gap", letter("distribution of angles")));
  sheet.panels.push_back({.x_title = "distance r (mm)",
                          .y_title = "g(r)",
                          .commands = {"set xrange [0:*]", level_line(1)},
                          .curves = bare(array_curves(both, "box.gap", "/g2/r_mm", "/g2/g")),
                          .title = letter("distances")});
  sheet.panels.push_back(key_panel("box.gap", "crystal measure, {/Symbol y}_6",
                                   together({{scalar_curve(both, "box.gap", "bragg_peak", "Bragg peak", 0)},
                                             {scalar_curve(both, "box.gap", "psi_6", "ψ6", 1)}}),
                                   letter("crystal")));
  return sheet;
}

Sheet elasticity_figure(const Material& material) {
  const RunSet longest = with_extreme(material.runs["layers"], kLength, true);
  const RunSet point = with_extreme(longest, kPacking, false);
  return {.title = "Director fluctuations",
          .panels = {
              key_panel(kPacking, "K_3 / K_1 (bend / splay)", {scalar_curve(longest, kPacking, "frank_ratio", "", 0)},
                        "(a) from the spectrum of the director", {"set yrange [0:*]", level_line(1)}),
              {.x_title = "wave number q (1/mm)",
               .y_title = "⟨|{/Symbol dq}_q|^2⟩",
               .style = Figure::Style::kPoints,
               .commands = {"set logscale xy"},
               .curves = positive({power_curve(point, true, 0), power_curve(point, false, 1)}),
               .title = "(b) least packed of the layered runs"}}};
}

}  // namespace shaken::study
