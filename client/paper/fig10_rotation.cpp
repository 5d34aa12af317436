// SPDX-License-Identifier: MIT
// Correlations in time of velocity and orientation, and rotational diffusion.
#include "client/paper/figures.h"

namespace shaken::client {

Sheet rotation_figure(const Material& material) {
  const RunSet& all = material.runs["phases"];
  const auto [shortest, longest, of_short, of_long] = BothLengths(all);
  const auto panel = [](const RunSet& runs, const char* lag, const char* array, std::string y_title, std::string title,
                        std::vector<std::string> commands) {
    return Figure{.x_title = "lag t (s)",
                  .y_title = std::move(y_title),
                  .commands = std::move(commands),
                  .curves = bare(array_curves(runs, "rods.area_fraction", lag, array)),
                  .title = std::move(title)};
  };
  const std::vector<std::string> log_x{"set logscale x", "set format x '10^{%T}'", "set yrange [-0.2:1.05]",
                                       level_line(0)};
  const std::vector<std::string> log_log{"set logscale xy", "set format xy '10^{%T}'"};
  const std::vector<std::string> early{"set xrange [0:5]", "set yrange [-0.2:1.05]", level_line(0)};
  Sheet sheet{.title = "Correlations in time", .columns = 3};
  sheet.panels.push_back(
      panel(shortest, "/velocity/lag_s", "/velocity/c_v", "C_v(t)", "(a) velocity" + of_short, early));
  sheet.panels.push_back(panel(longest, "/velocity/lag_s", "/velocity/c_v_along", "C_v(t) along the director",
                               "(b) velocity" + of_long, early));
  sheet.panels.push_back(
      panel(shortest, "/rotation/lag_s", "/rotation/c2", "C_2(t)", "(c) orientation" + of_short, log_x));
  sheet.panels.push_back(
      panel(longest, "/rotation/lag_s", "/rotation/c2", "C_2(t)", "(d) orientation" + of_long, log_x));
  sheet.panels.push_back(panel(shortest, "/rotation/lag_s", "/rotation/msad_rad2",
                               "mean square angular displacement (rad^2)", "(e) rotation" + of_short, log_log));
  sheet.panels.back().curves = positive(std::move(sheet.panels.back().curves));
  sheet.panels.push_back(
      {.x_title = axis_of("rods.area_fraction"),
       .y_title = "D_r (rad^2/s)",
       .style = Figure::Style::kLinesPoints,
       .commands = {"set logscale y"},
       .curves = positive(scalar_curves(all, "rods.length", "rods.area_fraction", "rotational_diffusion_rad2_s")),
       .title = "(f) rotational diffusion"});
  sheet.panels.push_back(panel(longest, "/rotation/lag_s", "/rotation/msad_rad2",
                               "mean square angular displacement (rad^2)", "(g) rotation" + of_long, log_log));
  sheet.panels.back().curves = positive(std::move(sheet.panels.back().curves));
  const auto against_packing = [&](std::string y_title, std::string title, std::vector<Curve> curves) {
    return Figure{.x_title = axis_of("rods.area_fraction"),
                  .y_title = std::move(y_title),
                  .style = Figure::Style::kLinesPoints,
                  .commands = {"set yrange [0:*]"},
                  .curves = std::move(curves),
                  .title = std::move(title)};
  };
  const std::string key = "rods.area_fraction";
  sheet.panels.push_back(against_packing("plateau of C_2", "(h) what of the orientation stays" + of_long,
                                         {scalar_curve(longest, key, "c2_plateau", "", 0)}));
  sheet.panels.push_back(
      against_packing("C_v(0) (mm^2/s^2)", "(i) variance of the velocity" + of_long,
                      together({{scalar_curve(longest, key, "velocity_variance_along_mm2_s2", "along the director", 0)},
                                {scalar_curve(longest, key, "velocity_variance_across_mm2_s2", "across", 1)}})));
  return sheet;
}

}  // namespace shaken::client
