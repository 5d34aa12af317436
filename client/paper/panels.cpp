// SPDX-License-Identifier: MIT
#include "client/paper/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "client/plotting/run_figures.h"
#include "client/results.h"

namespace shaken::client {

Curve array_curve(const RunSet& replicas, const std::string& x, const std::string& y, std::string label,
                  std::size_t colour, const std::string& sem) {
  Curve curve{.label = std::move(label), .colour = colour};
  std::vector<const std::vector<double>*> all;
  for (const FinishedRun& run : replicas) {
    const std::vector<double>& xs = run.array(x);
    const std::vector<double>& ys = run.array(y);
    if (xs.empty() || ys.size() != xs.size()) continue;
    if (all.empty()) {
      curve.x = xs;
      if (const auto& errors = run.array(sem); errors.size() == xs.size()) curve.y_error = errors;
    }
    if (xs == curve.x) all.push_back(&ys);
  }
  if (all.empty()) return curve;
  if (all.size() == 1) {
    curve.y = *all.front();
    return curve;
  }
  curve.y_error.assign(curve.x.size(), 0.0);
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    std::vector<double> values;
    for (const auto* ys : all) {
      if (std::isfinite((*ys)[k])) values.push_back((*ys)[k]);
    }
    const MeanAndError mean = values.empty() ? MeanAndError{NAN, {}} : mean_and_error(values);
    curve.y.push_back(mean.mean);
    curve.y_error[k] = mean.sem.value_or(NAN);
  }
  return curve;
}

Curve scalar_curve(const RunSet& runs, const std::string& key, const std::string& scalar, std::string label,
                   std::size_t colour) {
  Curve curve{.label = std::move(label), .colour = colour};
  for (const auto& [value, quantity] : scalar_points(runs, key, scalar)) {
    if (!quantity.is_known()) continue;
    curve.x.push_back(value);
    curve.y.push_back(quantity.value);
    curve.y_error.push_back(quantity.sem);
    curve.relaxing.push_back(quantity.steadiness == Steadiness::kRelaxing);
  }
  return curve;
}

BothLengths::BothLengths(const RunSet& runs)
    : shortest(with_extreme(runs, "rods.length", false)), longest(with_extreme(runs, "rods.length", true)) {
  if (shortest.empty()) return;
  of_short = ", " + value_label("rods.length", shortest.front().number("rods.length"));
  of_long = ", " + value_label("rods.length", longest.front().number("rods.length"));
}

std::string value_label(const std::string& key, double value) { return point_label(Json{{key, value}}); }

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

Figure empty_panel() { return {.commands = {"unset border", "unset tics", "unset label"}}; }

std::string axis_of(const std::string& key) { return axis_title(key); }

std::string level_line(double y) {
  return fmt::format(
      "set arrow from graph 0, first {0} to graph 1, first {0} nohead linecolor '#999999' dashtype 2 back", y);
}

}  // namespace shaken::client
