// SPDX-License-Identifier: MIT
// Mean square displacements of the isotropic and the nematic system, and what comes of them at long times.
#include "client/paper/figures.h"

namespace shaken::client {

Sheet diffusion_figure(const Material& material) {
  const auto [shortest, longest, of_short, of_long] = BothLengths(material.runs["phases"]);
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
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "D = MSD / 4t (mm^2/s)",
       .commands = {"set yrange [0:*]"},
       .curves = together({{scalar_curve(shortest, "rods.area_fraction", "diffusion_mm2_s", "long times", 0)},
                           {scalar_curve(shortest, "rods.area_fraction", "diffusion_short_mm2_s", "short times", 1)},
                           {law_curve(papers_diffusion, 0.6, 0.85, "Sharma & Soni's fit", 2)}}),
       .title = "(d) diffusion constant" + of_short});
  sheet.panels.back().style = Figure::Style::kLinesPoints;
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "D (mm^2/s)",
       .style = Figure::Style::kLinesPoints,
       .commands = {"set yrange [0:*]"},
       .curves = together({{scalar_curve(longest, "rods.area_fraction", "diffusion_along_mm2_s", "along", 0)},
                           {scalar_curve(longest, "rods.area_fraction", "diffusion_across_mm2_s", "across", 1)}}),
       .title = "(e) along and across the director" + of_long});
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "exponent {/Symbol a} of the MSD",
       .style = Figure::Style::kLinesPoints,
       .commands = {level_line(1)},
       .curves =
           together({{scalar_curve(shortest, "rods.area_fraction", "alpha_short", "short rods, short times", 0)},
                     {scalar_curve(longest, "rods.area_fraction", "alpha_along_short", "long rods, along", 1)},
                     {scalar_curve(longest, "rods.area_fraction", "alpha_across_short", "long rods, across", 2)}}),
       .title = "(f) normal diffusion: 1"});
  return sheet;
}

}  // namespace shaken::client
