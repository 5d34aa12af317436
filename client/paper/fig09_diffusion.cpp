// SPDX-License-Identifier: MIT
// Mean square displacements of the isotropic and the nematic system, and what comes of them at long times.
#include "client/paper/figures.h"

namespace shaken::client {
namespace {

/// MSD / (2 d t) against lag, and on it, thick and labelled, the window in which D is read.
std::vector<Curve> diffusion_curves(const RunSet& runs, const std::string& array) {
  std::vector<Curve> curves = bare(array_curves(runs, "rods.area_fraction", "/msd/lag_s", array));
  const std::size_t n = curves.size();
  for (std::size_t i = 0; i < n; ++i) {
    const RunSet here = where(runs, "rods.area_fraction", values_of(runs, "rods.area_fraction")[i]);
    const double from = here.front().scalar("diffusion_lag_from_s").value,
                 to = here.front().scalar("diffusion_lag_to_s").value;
    Curve window{.label = i + 1 == n ? "D is read here" : "", .colour = curves[i].colour, .look = Curve::Look::kPoints};
    for (std::size_t k = 0; k < curves[i].x.size(); ++k) {
      if (curves[i].x[k] < from * (1 - 1e-9) || curves[i].x[k] > to * (1 + 1e-9)) continue;
      window.x.push_back(curves[i].x[k]);
      window.y.push_back(curves[i].y[k]);
    }
    curves.push_back(std::move(window));
  }
  return positive(std::move(curves));
}

/// The runs made to follow rods for long, and those of the phase diagram at packings that have none.
RunSet followed(const Library& library, double length) {
  RunSet all = where(library["diffusion"], "rods.length", length);
  for (const double fraction : values_of(library["phases"], "rods.area_fraction")) {
    if (where(all, "rods.area_fraction", fraction).empty()) {
      all = joined(all, where(where(library["phases"], "rods.length", length), "rods.area_fraction", fraction));
    }
  }
  return all;
}

}  // namespace

Sheet diffusion_figure(const Material& material) {
  const auto [small_boxes, longest_once, of_short, of_long] = BothLengths(material.runs["phases"]);
  const RunSet shortest =
      small_boxes.empty() ? small_boxes : followed(material.runs, small_boxes.front().number("rods.length"));
  const RunSet longest =
      longest_once.empty() ? longest_once : followed(material.runs, longest_once.front().number("rods.length"));
  const std::vector<std::string> log_log{"set logscale xy", "set format xy '10^{%T}'"};
  const auto msd = [&](const RunSet& runs, const char* array, std::string title) {
    return Figure{.x_title = "lag {/Symbol t} (s)",
                  .y_title = "mean square displacement (mm^2)",
                  .commands = log_log,
                  .curves = positive(bare(array_curves(runs, "rods.area_fraction", "/msd/lag_s", array))),
                  .title = std::move(title)};
  };
  Sheet sheet{.title = "Diffusion", .columns = 3};
  sheet.panels.push_back(msd(shortest, "/msd/total_mm2", "(a) in the plane" + of_short));
  sheet.panels.push_back(msd(longest, "/msd/along_mm2", "(b) along the director" + of_long));
  sheet.panels.push_back(msd(longest, "/msd/across_mm2", "(c) across it" + of_long));
  const auto level = [&](const RunSet& runs, const char* array, std::string y_title, std::string title) {
    return Figure{.x_title = "lag {/Symbol t} (s)",
                  .y_title = std::move(y_title),
                  .commands = {"set logscale x", "set format x '10^{%T}'", "set xrange [0.1:*]", "set yrange [0:*]"},
                  .curves = diffusion_curves(runs, array),
                  .title = std::move(title)};
  };
  sheet.panels.push_back(
      level(shortest, "/msd/d_total_mm2_s", "MSD / 4t (mm^2/s)", "(d) does it level off?" + of_short));
  sheet.panels.push_back(level(longest, "/msd/d_along_mm2_s", "MSD / 2t (mm^2/s)", "(e) along the director" + of_long));
  sheet.panels.push_back(level(longest, "/msd/d_across_mm2_s", "MSD / 2t (mm^2/s)", "(f) across it" + of_long));
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "D = MSD / 4t (mm^2/s)",
       .commands = {"set yrange [0:*]"},
       .curves = together({{scalar_curve(shortest, "rods.area_fraction", "diffusion_mm2_s", "long times", 0)},
                           {scalar_curve(shortest, "rods.area_fraction", "diffusion_short_mm2_s", "short times", 1)},
                           {law_curve(papers_diffusion, 0.6, 0.85, "Sharma & Soni's fit", 2)}}),
       .title = "(g) diffusion constant" + of_short});
  sheet.panels.back().style = Figure::Style::kLinesPoints;
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "D (mm^2/s)",
       .style = Figure::Style::kLinesPoints,
       .commands = {"set yrange [0:*]"},
       .curves = together({{scalar_curve(longest, "rods.area_fraction", "diffusion_along_mm2_s", "along", 0)},
                           {scalar_curve(longest, "rods.area_fraction", "diffusion_across_mm2_s", "across", 1)}}),
       .title = "(h) along and across the director" + of_long});
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "exponent {/Symbol a} of the MSD",
       .style = Figure::Style::kLinesPoints,
       .commands = {level_line(1)},
       .curves =
           together({{scalar_curve(shortest, "rods.area_fraction", "alpha_short", "short rods, short times", 0)},
                     {scalar_curve(longest, "rods.area_fraction", "alpha_along_short", "long rods, along", 1)},
                     {scalar_curve(longest, "rods.area_fraction", "alpha_across_short", "long rods, across", 2)}}),
       .title = "(i) normal diffusion: 1"});
  return sheet;
}

}  // namespace shaken::client
