// SPDX-License-Identifier: MIT
// What the paper leaves for the future: shaking, melting, size, number fluctuations, elasticity, equilibrium.
#include "client/paper/figures.h"

namespace shaken::client {
namespace {

Figure against_packing(const RunSet& runs, const std::string& scalar, std::string y_title, std::string title,
                       std::vector<std::string> commands = {}) {
  return {.x_title = axis_of("rods.area_fraction"),
          .y_title = std::move(y_title),
          .style = Figure::Style::kLinesPoints,
          .commands = std::move(commands),
          .curves = scalar_curves(runs, "rods.length", "rods.area_fraction", scalar),
          .title = std::move(title)};
}

/// Area fraction at which <S> passes 0.5, in each box.
Curve transition_against_size(const RunSet& runs) {
  Curve curve;
  for (const double side : values_of(runs, "box.side")) {
    const Quantity phi =
        crossing(scalar_points(where(runs, "box.side", side), "rods.area_fraction", "order.mean"), 0.5);
    if (!phi.is_known()) continue;
    curve.x.push_back(side);
    curve.y.push_back(phi.value);
    curve.y_error.push_back(phi.sem);
    curve.relaxing.push_back(phi.steadiness == Steadiness::kRelaxing);
  }
  return curve;
}

}  // namespace

Sheet shaking_figure(const Material& material) {
  const RunSet& runs = material.runs["shaking"];
  const auto panel = [&](const char* scalar, std::string y_title, std::string title) {
    return Figure{.x_title = axis_of("plates.gamma"),
                  .y_title = std::move(y_title),
                  .style = Figure::Style::kLinesPoints,
                  .commands = {"set yrange [0:*]"},
                  .curves = scalar_curves(runs, "rods.length", "plates.gamma", scalar),
                  .title = std::move(title)};
  };
  return {.title = "The strength of shaking",
          .columns = 3,
          .panels = {panel("order.mean", "⟨S⟩", "(a) order"),
                     panel("diffusion_mm2_s", "D = MSD / 4t (mm^2/s)", "(b) diffusion"),
                     panel("rotational_diffusion_rad2_s", "D_r (rad^2/s)", "(c) rotation")}};
}

Sheet melting_figure(const Material& material) {
  const RunSet& runs = material.runs["phases"];
  const RunSet tracked = with_most_defects(material.runs["defects"]);
  return {.title = "Defects and melting",
          .panels = {against_packing(runs, "defect_density_per_mm2", "defects per area (1/mm^2)", "(a) defect density",
                                     {"set yrange [0:*]"}),
                     {.x_title = "⟨S⟩",
                      .y_title = "defects per area (1/mm^2)",
                      .style = Figure::Style::kPoints,
                      .commands = {"set xrange [0:1]", "set yrange [0:*]"},
                      .curves =
                          [&] {
                            std::vector<Curve> curves;
                            for (const double length : values_of(runs, "rods.length")) {
                              Curve curve{.label = value_label("rods.length", length), .colour = curves.size()};
                              for (const FinishedRun& run : where(runs, "rods.length", length)) {
                                curve.x.push_back(run.scalar("order.mean").value);
                                curve.y.push_back(run.scalar("defect_density_per_mm2").value);
                              }
                              curves.push_back(std::move(curve));
                            }
                            return curves;
                          }(),
                      .title = "(b) defect density against order"},
                     defect_speed_panel(tracked, "(c) speeds of +1/2 and −1/2"),
                     against_packing(runs, "order.mean", "⟨S⟩", "(d) order", {"set yrange [0:1]", level_line(0.5)})}};
}

Sheet size_figure(const Material& material) {
  const RunSet runs = joined(material.runs["size"], with_extreme(material.runs["phases"], "rods.length", true));
  RunSet common;  // packings that were run in several boxes
  for (const double fraction : values_of(material.runs["size"], "rods.area_fraction")) {
    common = joined(common, where(runs, "rods.area_fraction", fraction));
  }
  return {.title = "Order against the size of the box",
          .panels = {{.x_title = axis_of("rods.area_fraction"),
                      .y_title = "⟨S⟩",
                      .style = Figure::Style::kLinesPoints,
                      .commands = {"set yrange [0:1]", level_line(0.5)},
                      .curves = scalar_curves(runs, "box.side", "rods.area_fraction", "order.mean"),
                      .title = "(a) order"},
                     {.x_title = axis_of("rods.area_fraction"),
                      .y_title = "Binder cumulant",
                      .style = Figure::Style::kLinesPoints,
                      .commands = {"set yrange [-0.2:1.1]", level_line(0), level_line(1)},
                      .curves = scalar_curves(runs, "box.side", "rods.area_fraction", "binder"),
                      .title = "(b) Binder cumulant"},
                     {.x_title = axis_of("box.side"),
                      .y_title = "⟨S⟩",
                      .style = Figure::Style::kLinesPoints,
                      .commands = {"set logscale xy", "set xtics (10, 20, 40, 80, 160)"},
                      .curves = positive(scalar_curves(common, "rods.area_fraction", "box.side", "order.mean")),
                      .title = "(c) order against size: level, a small power, or 1/L"},
                     {.x_title = axis_of("box.side"),
                      .y_title = axis_of("rods.area_fraction"),
                      .style = Figure::Style::kLinesPoints,
                      .commands = {"set logscale x", "set xtics (10, 20, 40, 80, 160)"},
                      .curves = {transition_against_size(runs)},
                      .title = "(d) where ⟨S⟩ passes 0.5"}}};
}

Sheet fluctuations_figure(const Material& material) {
  const auto panel = [&](const RunSet& runs, const char* array, std::string title) {
    Figure figure{.x_title = "mean number in a box ⟨N⟩",
                  .y_title = "standard deviation {/Symbol D}N",
                  .style = Figure::Style::kLinesPoints,
                  .commands = {"set logscale xy"},
                  .curves = positive(bare(array_curves(runs, "rods.area_fraction", "/fluctuations/mean_n", array))),
                  .title = std::move(title)};
    Curve law = law_curve([](double n) { return std::sqrt(n); }, 1, 100, "√N: independent", figure.curves.size());
    figure.curves.push_back(std::move(law));
    return figure;
  };
  const RunSet longest = with_extreme(material.runs["phases"], "rods.length", true);
  const RunSet shortest = with_extreme(material.runs["phases"], "rods.length", false);
  const RunSet equilibrium = with_extreme(material.runs["equilibrium"], "rods.length", true);
  return {.title = "Number fluctuations",
          .panels = {
              panel(longest, "/fluctuations/std_n", "(a) longest rods"),
              panel(longest, "/fluctuations/std_n_without_map", "(b) longest rods, mean density map removed"),
              panel(shortest, "/fluctuations/std_n_without_map", "(c) shortest rods, map removed"),
              panel(equilibrium, "/fluctuations/std_n_without_map", "(d) longest rods in equilibrium, map removed")}};
}

Sheet elasticity_figure(const Material& material) {
  const RunSet& runs = material.runs["layers"];
  std::vector<Curve> ratio{
      scalar_curve(with_extreme(runs, "rods.length", true), "rods.area_fraction", "frank_ratio", "", 0)};
  Sheet sheet{.title = "Director fluctuations"};
  sheet.panels.push_back({.x_title = axis_of("rods.area_fraction"),
                          .y_title = "K_3 / K_1 (bend / splay)",
                          .style = Figure::Style::kLinesPoints,
                          .commands = {"set yrange [0:*]", level_line(1)},
                          .curves = std::move(ratio),
                          .title = "(a) from the spectrum of the director"});
  const RunSet point = [&] {
    const RunSet longest = with_extreme(runs, "rods.length", true);
    const auto fractions = values_of(longest, "rods.area_fraction");
    return fractions.empty() ? RunSet{} : where(longest, "rods.area_fraction", fractions.front());
  }();
  // power against wave number, for wave vectors nearly along and nearly across the director
  std::vector<Curve> cuts;
  for (const bool along : {true, false}) {
    Curve cut{.label = along ? "along: bend" : "across: splay", .colour = cuts.size()};
    for (const FinishedRun& run : point) {
      const auto& q_along = run.array("/frank/q_along_per_mm");
      const auto& q_across = run.array("/frank/q_across_per_mm");
      const auto& power = run.array("/frank/power_mm2");
      for (std::size_t k = 0; k < std::min({q_along.size(), q_across.size(), power.size()}); ++k) {
        const double a = std::abs(q_along[k]), b = std::abs(q_across[k]);
        if ((along ? b : a) > 0.35 * (along ? a : b)) continue;
        cut.x.push_back(std::hypot(a, b));
        cut.y.push_back(power[k]);
      }
    }
    cuts.push_back(std::move(cut));
  }
  sheet.panels.push_back({.x_title = "wave number q (1/mm)",
                          .y_title = "⟨|{/Symbol dq}_q|^2⟩",
                          .style = Figure::Style::kPoints,
                          .commands = {"set logscale xy"},
                          .curves = positive(std::move(cuts)),
                          .title = "(b) least packed of the layered runs"});
  return sheet;
}

Sheet equilibrium_figure(const Material& material) {
  const RunSet& driven = material.runs["phases"];
  const RunSet& still = material.runs["equilibrium"];
  Sheet sheet{.title = "Shaken against equilibrium"};
  char letter = 'a';
  for (const bool longest : {true, false}) {
    const RunSet a = with_extreme(driven, "rods.length", longest), b = with_extreme(still, "rods.length", longest);
    const std::string point = b.empty() ? "" : ", " + value_label("rods.length", b.front().number("rods.length"));
    sheet.panels.push_back(
        {.x_title = axis_of("rods.area_fraction"),
         .y_title = "⟨S⟩",
         .style = Figure::Style::kLinesPoints,
         .commands = {"set yrange [0:1]", level_line(0.5)},
         .curves = together({{scalar_curve(a, "rods.area_fraction", "order.mean", "shaken", 0)},
                             {scalar_curve(b, "rods.area_fraction", "order.mean", "equilibrium", 1)}}),
         .title = std::string("(") + letter++ + ") order" + point});
    sheet.panels.push_back({.x_title = axis_of("rods.area_fraction"),
                            .y_title = "D / D at the lowest packing",
                            .style = Figure::Style::kLinesPoints,
                            .commands = {"set yrange [0:*]"},
                            .curves =
                                [&] {
                                  std::vector<Curve> curves = together(
                                      {{scalar_curve(a, "rods.area_fraction", "diffusion_mm2_s", "shaken", 0)},
                                       {scalar_curve(b, "rods.area_fraction", "diffusion_mm2_s", "equilibrium", 1)}});
                                  for (Curve& curve : curves) {
                                    const double first = curve.y.empty() ? 1 : curve.y.front();
                                    for (double& y : curve.y) y /= first;
                                    for (double& error : curve.y_error) error /= first;
                                  }
                                  return curves;
                                }(),
                            .title = std::string("(") + letter++ + ") diffusion" + point});
  }
  return sheet;
}

}  // namespace shaken::client
