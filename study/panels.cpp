// SPDX-License-Identifier: MIT
#include "study/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "client/plotting/run_figures.h"

namespace shaken::study {

namespace {

/// A record in time has many more points than a panel has pixels; those left out would only make the files large.
Curve thinned(Curve curve) {
  constexpr std::size_t kMostPoints = 600;
  const std::size_t step = (curve.x.size() + kMostPoints - 1) / kMostPoints;
  if (step <= 1 || !curve.y_error.empty()) return curve;
  std::size_t n = 0;
  for (std::size_t i = 0; i < curve.x.size(); i += step, ++n) {
    curve.x[n] = curve.x[i];
    curve.y[n] = curve.y[i];
  }
  curve.x.resize(n);
  curve.y.resize(n);
  return curve;
}

}  // namespace

Curve array_curve(const RunSet& replicas, const std::string& x, const std::string& y, std::string label,
                  std::size_t colour, const std::string& sem) {
  std::vector<Curve> curves;
  for (const FinishedRun& run : replicas) {
    Curve curve{.label = label, .colour = colour, .x = run.array(x), .y = run.array(y), .y_error = run.array(sem)};
    if (curve.x.empty() || curve.y.size() != curve.x.size()) continue;
    if (curve.y_error.size() != curve.x.size()) curve.y_error.clear();
    if (curves.empty() || curve.x == curves.front().x) curves.push_back(std::move(curve));
  }
  return curves.empty() ? Curve{.label = std::move(label), .colour = colour} : thinned(client::mean_curve(curves));
}

Curve scalar_curve(const RunSet& runs, const std::string& key, const std::string& scalar, std::string label,
                   std::size_t colour) {
  Curve curve{.label = std::move(label), .colour = colour};
  for (const auto& [value, estimate] : scalar_points(runs, key, scalar)) {
    if (!is_known(estimate)) continue;
    curve.x.push_back(value);
    curve.y.push_back(estimate.value);
    curve.y_error.push_back(estimate.sem);
    curve.unsteady.push_back(estimate.steady != true);
  }
  return curve;
}

BothLengths::BothLengths(const RunSet& runs)
    : shortest(with_extreme(runs, kLength, false)), longest(with_extreme(runs, kLength, true)) {
  if (shortest.empty()) return;
  of_short = ", " + label_of(shortest, kLength);
  of_long = ", " + label_of(longest, kLength);
}

std::string value_label(const std::string& key, double value) { return client::point_label(Json{{key, value}}); }

std::string label_of(const RunSet& runs, const std::string& key) { return value_label(key, runs.front().number(key)); }

std::vector<Curve> array_curves(const RunSet& runs, const std::string& key, const std::string& x, const std::string& y,
                                const std::string& sem) {
  std::vector<Curve> curves;
  std::size_t colour = 0;
  for (const double value : values_of(runs, key)) {
    curves.push_back(array_curve(where(runs, key, value), x, y, value_label(key, value), colour++, sem));
  }
  return curves;
}

std::vector<Curve> scalar_curves(const RunSet& runs, const std::string& series, const std::string& key,
                                 const std::string& scalar) {
  std::vector<Curve> curves;
  std::size_t colour = 0;
  for (const double value : values_of(runs, series)) {
    curves.push_back(scalar_curve(where(runs, series, value), key, scalar, value_label(series, value), colour++));
  }
  return curves;
}

Curve law_curve(const std::function<double(double)>& law, double from, double to, std::string label, std::size_t colour,
                int n) {
  Curve curve{.label = std::move(label), .colour = colour, .look = Curve::Look::kDashes};
  for (int i = 0; i < n; ++i) {
    const double x = from + (to - from) * i / (n - 1);
    curve.x.push_back(x);
    curve.y.push_back(law(x));
  }
  return curve;
}

std::vector<Curve> positive(std::vector<Curve> curves) {
  for (Curve& curve : curves) {
    for (std::size_t k = 0; k < curve.y.size(); ++k) {
      if (!(curve.x[k] > 0) || !(curve.y[k] > 0)) curve.y[k] = NAN;
    }
  }
  return curves;
}

std::vector<Curve> bare(std::vector<Curve> curves) {
  for (Curve& curve : curves) curve.y_error.clear();
  return curves;
}

std::vector<Curve> together(std::vector<std::vector<Curve>> groups) {
  std::vector<Curve> all;
  for (std::vector<Curve>& group : groups) {
    for (Curve& curve : group) {
      curve.colour = all.size();
      all.push_back(std::move(curve));
    }
  }
  return all;
}

Map map_of(const FinishedRun& run, const std::string& x, const std::string& y, const std::string& z, bool diverging) {
  Map map{.x = run.array(x), .y = run.array(y), .z = run.array(z), .diverging = diverging};
  if (map.z.size() != map.x.size() * map.y.size()) return {};
  return map;
}

Figure snapshot_panel(const Material& material, const RunSet& runs, std::string title) {
  Figure panel{.title = std::move(title)};
  if (!runs.empty()) panel.picture = material.snapshot(runs.front());
  if (panel.picture.empty()) {
    panel.title += " (no picture)";
    panel.commands = {"unset border", "unset tics", "set xrange [0:1]", "set yrange [0:1]"};
  }
  return panel;
}

double papers_diffusion(double area_fraction) { return 1.7 + 480 * std::pow(area_fraction - 0.64, 2); }

double order_spread(const RunSet& replicas) {
  if (replicas.empty()) return NAN;
  return std::sqrt(mean_scalar(replicas, "susceptibility").value / replicas.front().scalar("n_rods").value);
}

void fill_row(Sheet& sheet) {
  while (sheet.panels.size() % static_cast<std::size_t>(sheet.columns) != 0) {
    sheet.panels.push_back({.commands = {"unset border", "unset tics", "unset label"}});
  }
}

Figure key_panel(const std::string& key, std::string y_title, std::vector<Curve> curves, std::string title,
                 std::vector<std::string> commands) {
  return {.x_title = axis_of(key),
          .y_title = std::move(y_title),
          .style = Figure::Style::kLinesPoints,
          .commands = std::move(commands),
          .curves = std::move(curves),
          .title = std::move(title)};
}

Figure start_panel(const RunSet& runs, std::string title) {
  return {.x_title = "time t (s)",
          .y_title = "nematic order S",
          .commands = {"set xrange [0:*]", "set yrange [0:1]"},
          .curves = array_curves(with_extreme(runs, "time.seed", false), kPacking, "/order/time_s", "/order/order"),
          .title = std::move(title)};
}

Figure angles_panel(const RunSet& runs, const std::string& key, std::string title) {
  return {.x_title = "angle to the director {/Symbol q} (rad)",
          .y_title = "P({/Symbol q}) (1/rad)",
          .commands = {"set xrange [-0.8:0.8]", "set yrange [0:*]"},
          .curves = bare(array_curves(runs, key, "/angles/theta_rad", "/angles/density_per_rad")),
          .title = std::move(title)};
}

Figure distance_panel(const RunSet& runs, const std::string& what, std::string y_title, std::string title) {
  return {.x_title = "distance r (mm)",
          .y_title = std::move(y_title),
          .commands = {"set xrange [0:*]", level_line(what == "g2" ? 0 : 1)},
          .curves = bare(array_curves(runs, kPacking, "/g2/r_mm", "/g2/" + what)),
          .title = std::move(title)};
}

Figure g2_across_panel(const RunSet& runs, const std::string& key, std::string title) {
  return {.x_title = "distance across the director (mm)",
          .y_title = "G_2",
          .commands = {"set xrange [0:*]"},
          .curves = bare(array_curves(runs, key, "/pairs/cut/r_mm", "/pairs/cut/g2_across")),
          .title = std::move(title)};
}

Estimate transition(const RunSet& runs) { return crossing(scalar_points(runs, kPacking, "order.mean"), 0.5); }

std::vector<Point> transitions(const RunSet& runs, const std::string& key) {
  std::vector<Point> points;
  for (const double value : values_of(runs, key)) {
    const Estimate phi = transition(where(runs, key, value));
    if (is_known(phi)) points.push_back({value, phi});
  }
  return points;
}

std::string axis_of(const std::string& key) { return client::axis_title(key); }

std::string level_line(double y) {
  return fmt::format(
      "set arrow from graph 0, first {0} to graph 1, first {0} nohead linecolor '#999999' dashtype 2 back", y);
}

}  // namespace shaken::study
