// SPDX-License-Identifier: MIT
// Motion: how a rod swims, diffuses and turns, and what the strength of shaking does to it.
#include <fmt/format.h>

#include <algorithm>

#include "study/figures.h"

namespace shaken::study {
namespace {

std::vector<std::string> log_log() { return {"set logscale xy", "set format xy '10^{%T}'"}; }

/// As much of a trace as can be seen in print: the first two seconds.
Curve beginning(Curve trace) {
  std::size_t n = 0;
  while (n < trace.x.size() && trace.x[n] < trace.x.front() + 2.0) ++n;
  trace.x.resize(n);
  trace.y.resize(n);
  return trace;
}

/// The same scale for both axes, with all curves inside.
std::vector<std::string> square_ranges(const std::vector<Curve>& curves) {
  double low[2] = {0, 0}, high[2] = {0, 0};
  for (const Curve& curve : curves) {
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      const double place[2] = {curve.x[k], curve.y[k]};
      for (int axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], place[axis]);
        high[axis] = std::max(high[axis], place[axis]);
      }
    }
  }
  const double half = 0.55 * std::max({high[0] - low[0], high[1] - low[1], 1e-6});
  std::vector<std::string> commands{"set size ratio 1"};
  for (int axis = 0; axis < 2; ++axis) {
    const double middle = (low[axis] + high[axis]) / 2;
    commands.push_back(fmt::format("set {}range [{}:{}]", axis == 0 ? 'x' : 'y', middle - half, middle + half));
  }
  return commands;
}

/// The paths of single rods, each from where it began.
std::vector<Curve> traces_of(const RunSet& runs) {
  std::vector<Curve> traces;
  for (std::size_t k = 0;; ++k) {
    Curve trace =
        array_curve(runs, fmt::format("/rods/trace/{}/x_mm", k), fmt::format("/rods/trace/{}/y_mm", k), "", k);
    if (trace.x.empty()) return traces;
    const double x = trace.x.front(), y = trace.y.front();
    for (double& value : trace.x) value -= x;
    for (double& value : trace.y) value -= y;
    traces.push_back(std::move(trace));
  }
}

/// A mean velocity against the tilt.
Figure velocity_panel(const RunSet& runs, const std::string& way, std::string y_title, std::string title) {
  const std::string array = "/tilt/v_" + way;
  return {.x_title = "tilt n_z",
          .y_title = std::move(y_title),
          .style = Figure::Style::kLinesPoints,
          .commands = {"set xzeroaxis linecolor '#999999'", "set yzeroaxis linecolor '#999999'"},
          .curves = {array_curve(runs, "/tilt/n_z", array + "_mm_s", "", 0, array + "_sem_mm_s")},
          .title = std::move(title)};
}

/// MSD / (2 d t) against lag, and on it, thick and labelled, the window in which D is read.
std::vector<Curve> diffusion_curves(const RunSet& runs, const std::string& array) {
  std::vector<Curve> curves = bare(array_curves(runs, kPacking, "/msd/lag_s", array));
  const std::size_t n = curves.size();
  for (std::size_t i = 0; i < n; ++i) {
    const RunSet here = where(runs, kPacking, values_of(runs, kPacking)[i]);
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
  RunSet all = where(library["diffusion"], kLength, length);
  for (const double fraction : values_of(library["phases"], kPacking)) {
    if (where(all, kPacking, fraction).empty()) {
      all = joined(all, where(where(library["phases"], kLength, length), kPacking, fraction));
    }
  }
  return all;
}

/// Curves against a lag, one for each packing.
Figure lag_panel(std::string x_title, std::string y_title, std::vector<Curve> curves, std::string title,
                 std::vector<std::string> commands) {
  return {.x_title = std::move(x_title),
          .y_title = std::move(y_title),
          .commands = std::move(commands),
          .curves = std::move(curves),
          .title = std::move(title)};
}

}  // namespace

Sheet tilt_figure(const Material& material) {
  const RunSet& all = material.runs["mechanism"];
  const RunSet first = with_extreme(all, kPacking, false);
  const std::string point = first.empty() ? "" : ", " + label_of(first, kPacking);
  return {
      .title = "How a rod swims",
      .panels = {velocity_panel(first, "along", "⟨v^n⟩ along the rod (mm/s)", "(a) velocity along the rod" + point),
                 velocity_panel(first, "across", "⟨v^t⟩ across the rod (mm/s)", "(b) velocity across the rod" + point),
                 {.x_title = "tilt n_z",
                  .y_title = "P(n_z)",
                  .commands = {"set yrange [0:*]"},
                  .curves = bare(array_curves(all, kPacking, "/tilt/n_z", "/tilt/density")),
                  .title = "(c) how often a tilt occurs"},
                 {.x_title = "time t (s)",
                  .y_title = "tilt n_z",
                  .commands = {"set xrange [*:*] noextend", "set yrange [-0.4:0.4]"},
                  .curves = {beginning(array_curve(first, "/rods/trace/time_s", "/rods/trace/0/n_z", "", 0))},
                  .title = "(d) tilt of one rod" + point}}};
}

Sheet paths_figure(const Material& material) {
  const RunSet& all = material.runs["mechanism"];
  const std::vector<double> fractions = values_of(all, kPacking);
  Sheet sheet{.title = "Paths of single rods", .columns = 3};
  Letters letter;
  for (const double fraction : fractions) {
    if (fraction == fractions.front() && fractions.size() > 2) continue;  // the paper shows the denser two
    std::vector<Curve> traces = traces_of(where(all, kPacking, fraction));
    sheet.panels.push_back({.x_title = "x (mm)",
                            .y_title = "y (mm)",
                            .commands = square_ranges(traces),
                            .curves = bare(std::move(traces)),
                            .title = letter("paths, " + value_label(kPacking, fraction))});
  }
  sheet.panels.push_back(
      key_panel(kPacking, "time (s)",
                together({{scalar_curve(all, kPacking, "persistence_time_s", "a way persists", 0)},
                          {scalar_curve(all, kPacking, "n_z_switching_time_s", "a tilt keeps its sign", 1)}}),
                letter("how long rods keep their way")));
  return sheet;
}

Sheet diffusion_figure(const Material& material) {
  const auto [small_boxes, longest_once, of_short, of_long] = BothLengths(material.runs["phases"]);
  const RunSet shortest =
      small_boxes.empty() ? small_boxes : followed(material.runs, small_boxes.front().number(kLength));
  const RunSet longest =
      longest_once.empty() ? longest_once : followed(material.runs, longest_once.front().number(kLength));
  const std::string lag = "lag {/Symbol t} (s)";
  const auto msd = [&](const RunSet& runs, const char* array, std::string title) {
    return lag_panel(lag, "mean square displacement (mm^2)",
                     positive(bare(array_curves(runs, kPacking, "/msd/lag_s", array))), std::move(title), log_log());
  };
  const auto level = [&](const RunSet& runs, const char* array, std::string y_title, std::string title) {
    return lag_panel(lag, std::move(y_title), diffusion_curves(runs, array), std::move(title),
                     {"set logscale x", "set format x '10^{%T}'", "set xrange [0.1:*]", "set yrange [0:*]"});
  };
  const auto curve = [](const RunSet& runs, const char* scalar, const char* label) {
    return std::vector<Curve>{scalar_curve(runs, kPacking, scalar, label, 0)};
  };
  return {.title = "Diffusion",
          .columns = 3,
          .panels = {msd(shortest, "/msd/total_mm2", "(a) in the plane" + of_short),
                     msd(longest, "/msd/along_mm2", "(b) along the director" + of_long),
                     msd(longest, "/msd/across_mm2", "(c) across it" + of_long),
                     level(shortest, "/msd/d_total_mm2_s", "MSD / 4t (mm^2/s)", "(d) does it level off?" + of_short),
                     level(longest, "/msd/d_along_mm2_s", "MSD / 2t (mm^2/s)", "(e) along the director" + of_long),
                     level(longest, "/msd/d_across_mm2_s", "MSD / 2t (mm^2/s)", "(f) across it" + of_long),
                     key_panel(kPacking, "D = MSD / 4t (mm^2/s)",
                               together({curve(shortest, "diffusion_mm2_s", "long times"),
                                         curve(shortest, "diffusion_short_mm2_s", "short times"),
                                         {law_curve(papers_diffusion, 0.6, 0.85, "Sharma & Soni's fit", 2)}}),
                               "(g) diffusion constant" + of_short),
                     key_panel(kPacking, "D (mm^2/s)",
                               together({curve(longest, "diffusion_along_mm2_s", "along"),
                                         curve(longest, "diffusion_across_mm2_s", "across")}),
                               "(h) along and across the director" + of_long),
                     key_panel(kPacking, "exponent {/Symbol a} of the MSD",
                               together({curve(shortest, "alpha_short", "short rods, short times"),
                                         curve(longest, "alpha_along_short", "long rods, along"),
                                         curve(longest, "alpha_across_short", "long rods, across")}),
                               "(i) normal diffusion: 1", {level_line(1)})}};
}

Sheet memory_figure(const Material& material) {
  const auto [shortest, longest, of_short, of_long] = BothLengths(material.runs["phases"]);
  const auto panel = [](const RunSet& runs, const std::string& array, std::string y_title, std::string title,
                        std::vector<std::string> commands) {
    const std::string lag = array.substr(0, array.rfind('/')) + "/lag_s";
    return lag_panel("lag t (s)", std::move(y_title), bare(array_curves(runs, kPacking, lag, array)), std::move(title),
                     std::move(commands));
  };
  const std::vector<std::string> log_x{"set logscale x", "set format x '10^{%T}'", "set yrange [-0.2:1.05]",
                                       level_line(0)};
  const std::vector<std::string> early{"set xrange [0:5]", "set yrange [-0.2:1.05]", level_line(0)};
  return {
      .title = "Correlations in time",
      .columns = 3,
      .panels = {
          panel(shortest, "/rotation/c2", "C_2(t)", "(a) orientation" + of_short, log_x),
          panel(longest, "/rotation/c2", "C_2(t)", "(b) orientation" + of_long, log_x),
          key_panel(kPacking, "plateau of C_2", {scalar_curve(longest, kPacking, "c2_plateau", "", 0)},
                    "(c) what of the orientation stays" + of_long),
          panel(shortest, "/velocity/c_v", "C_v(t)", "(d) velocity" + of_short, early),
          panel(longest, "/velocity/c_v_along", "C_v(t) along the director", "(e) velocity" + of_long, early),
          key_panel(
              kPacking, "C_v(0) (mm^2/s^2)",
              together({{scalar_curve(longest, kPacking, "velocity_variance_along_mm2_s2", "along the director", 0)},
                        {scalar_curve(longest, kPacking, "velocity_variance_across_mm2_s2", "across", 1)}}),
              "(f) variance of the velocity" + of_long)}};
}

Sheet rotation_figure(const Material& material) {
  const RunSet& all = material.runs["phases"];
  const auto [shortest, longest, of_short, of_long] = BothLengths(all);
  const auto turning = [](const RunSet& runs, std::string title) {
    return lag_panel("lag t (s)", "mean square angular displacement (rad^2)",
                     positive(bare(array_curves(runs, kPacking, "/rotation/lag_s", "/rotation/msad_rad2"))),
                     std::move(title), log_log());
  };
  return {.title = "Rotation",
          .columns = 3,
          .panels = {turning(shortest, "(a) rotation" + of_short), turning(longest, "(b) rotation" + of_long),
                     key_panel(kPacking, "D_r (rad^2/s)",
                               positive(scalar_curves(all, kLength, kPacking, "rotational_diffusion_rad2_s")),
                               "(c) rotational diffusion", {"set logscale y"})}};
}

Sheet shaking_figure(const Material& material) {
  const RunSet& runs = material.runs["shaking"];
  const auto panel = [&](const char* scalar, std::string y_title, std::string title) {
    return key_panel("plates.gamma", std::move(y_title), scalar_curves(runs, kLength, "plates.gamma", scalar),
                     std::move(title));
  };
  return {.title = "The strength of shaking",
          .columns = 3,
          .panels = {panel("order.mean", "⟨S⟩", "(a) order"),
                     panel("diffusion_mm2_s", "D = MSD / 4t (mm^2/s)", "(b) diffusion"),
                     panel("rotational_diffusion_rad2_s", "D_r (rad^2/s)", "(c) rotation")}};
}

}  // namespace shaken::study
