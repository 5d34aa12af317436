// SPDX-License-Identifier: MIT
// Defects: of systems that are ordered here and there, and as the order melts.
#include "study/figures.h"

namespace shaken::study {
namespace {

/// How fast defects move, by the time over which their way is taken.
Figure defect_speed_panel(const RunSet& runs, std::string title) {
  const auto curve = [&](const std::string& name, std::string label) {
    return array_curve(runs, "/defects/tracks/span_s", "/defects/tracks/lasting/" + name + "_mm_s", std::move(label), 0,
                       "/defects/tracks/lasting/" + name + "_sem_mm_s");
  };
  return {.x_title = "time over which a core's way is taken (s)",
          .y_title = "mean speed (mm/s)",
          .style = Figure::Style::kLinesPoints,
          .commands = {"set logscale x 2", "set xzeroaxis linecolor '#999999'"},
          .curves = together({{curve("speed_plus", "charge +1/2")},
                              {curve("speed_minus", "charge −1/2")},
                              {curve("speed_plus_along", "+1/2, towards its tail")}}),
          .title = std::move(title)};
}

/// Defect density against order, a point for each run, a curve for each rod length.
std::vector<Curve> density_against_order(const RunSet& runs) {
  std::vector<Curve> curves;
  for (const double length : values_of(runs, kLength)) {
    Curve curve{.label = value_label(kLength, length), .colour = curves.size()};
    for (const FinishedRun& run : where(runs, kLength, length)) {
      curve.x.push_back(run.scalar("order.mean").value);
      curve.y.push_back(run.scalar("defect_density_per_mm2").value);
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace

RunSet with_most_defects(const RunSet& runs) {
  RunSet most;
  for (const FinishedRun& run : runs) {
    const double density = run.scalar("defect_density_per_mm2").value;
    if (most.empty() || density > most.front().scalar("defect_density_per_mm2").value) most = {run};
  }
  return most;
}

Sheet defects_figure(const Material& material) {
  const RunSet& runs = material.runs["defects"];
  Sheet sheet{.title = "Defects of systems that are ordered here and there", .columns = 3};
  Letters letter;
  for (const double length : values_of(runs, kLength)) {
    const RunSet here = where(runs, kLength, length);
    sheet.panels.push_back(
        snapshot_panel(material, here, letter(value_label(kLength, length) + ", " + label_of(here, kPacking))));
  }
  sheet.panels.push_back({.x_title = "time t (s)",
                          .y_title = "defects of charge +1/2",
                          .commands = {"set xrange [0:*]", "set yrange [0:*]"},
                          .curves = bare(array_curves(runs, kLength, "/defects/time_s", "/defects/n_plus")),
                          .title = letter("number, equal to that of charge −1/2")});
  sheet.panels.push_back(
      defect_speed_panel(with_most_defects(runs), letter("speeds of those that last, where there are most")));
  sheet.panels.push_back({.x_title = "distance r (mm)",
                          .y_title = "G_2(r)",
                          .commands = {"set xrange [0:*]", "set yrange [*<0:*]", level_line(0)},
                          .curves = bare(array_curves(runs, kLength, "/g2/r_mm", "/g2/g2")),
                          .title = letter("orientational correlation")});
  return sheet;
}

Sheet melting_figure(const Material& material) {
  const RunSet& runs = material.runs["phases"];
  const RunSet tracked = with_most_defects(material.runs["defects"]);
  const auto against_packing = [&](const char* scalar) { return scalar_curves(runs, kLength, kPacking, scalar); };
  return {.title = "Defects and melting",
          .panels = {key_panel(kPacking, "defects per area (1/mm^2)", against_packing("defect_density_per_mm2"),
                               "(a) defect density"),
                     {.x_title = "⟨S⟩",
                      .y_title = "defects per area (1/mm^2)",
                      .style = Figure::Style::kPoints,
                      .commands = {"set xrange [0:1]", "set yrange [0:*]"},
                      .curves = density_against_order(runs),
                      .title = "(b) defect density against order"},
                     defect_speed_panel(tracked, "(c) speeds of +1/2 and −1/2"),
                     key_panel(kPacking, "⟨S⟩", against_packing("order.mean"), "(d) order",
                               {"set yrange [0:1]", level_line(0.5)})}};
}

}  // namespace shaken::study
