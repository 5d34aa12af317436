// SPDX-License-Identifier: MIT
// Nematic order against area fraction and rod length, and where it sets in.
#include <cmath>

#include "client/paper/figures.h"

namespace shaken::client {
namespace {

/// <S> on the plane of area fraction and rod length.
Map phase_map(const RunSet& runs) {
  Map map{.x = values_of(runs, "rods.area_fraction"), .y = values_of(runs, "rods.length")};
  for (const double length : map.y) {
    for (const double fraction : map.x) {
      const RunSet here = where(where(runs, "rods.length", length), "rods.area_fraction", fraction);
      map.z.push_back(mean_scalar(here, "order.mean").value);
    }
  }
  return map;
}

/// Area fraction at which <S> passes 0.5, for every rod length that has one.
Curve transition_curve(const RunSet& runs) {
  Curve curve{.label = "⟨S⟩ = 0.5", .look = Curve::Look::kPoints};
  for (const double length : values_of(runs, "rods.length")) {
    const Quantity phi =
        crossing(scalar_points(where(runs, "rods.length", length), "rods.area_fraction", "order.mean"), 0.5);
    if (!phi.is_known()) continue;
    curve.x.push_back(phi.value);
    curve.y.push_back(length);
    curve.relaxing.push_back(phi.steadiness == Steadiness::kRelaxing);
  }
  return curve;
}

}  // namespace

Sheet order_figure(const Material& material) {
  const RunSet& runs = material.runs["phases"];
  const std::vector<double> lengths = values_of(runs, "rods.length");
  // The paper's bars are the standard deviation of S(t), how far it swings, not the error of its mean.
  std::vector<Curve> mean = scalar_curves(runs, "rods.length", "rods.area_fraction", "order.mean");
  std::vector<Curve> spread;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    Curve curve{.label = value_label("rods.length", lengths[i]), .colour = i};
    const RunSet column = where(runs, "rods.length", lengths[i]);
    for (std::size_t k = 0; k < mean[i].x.size(); ++k) {
      curve.x.push_back(mean[i].x[k]);
      curve.y.push_back(order_spread(where(column, "rods.area_fraction", mean[i].x[k])));
      curve.relaxing.push_back(mean[i].relaxing[k]);
      mean[i].y_error[k] = curve.y.back();
    }
    spread.push_back(std::move(curve));
  }
  const RunSet longest = lengths.empty() ? RunSet{} : where(runs, "rods.length", lengths.back());

  Sheet sheet{.title = "Nematic order"};
  sheet.panels.push_back({.x_title = "time t (s)",
                          .y_title = "nematic order S",
                          .commands = {"set xrange [0:*]", "set yrange [0:1]"},
                          .curves = array_curves(with_extreme(longest, "time.seed", false), "rods.area_fraction",
                                                 "/order/time_s", "/order/order"),
                          .title = "(a) from the aligned start, longest rods"});
  sheet.panels.push_back({.x_title = axis_of("rods.area_fraction"),
                          .y_title = "⟨S⟩; bars: standard deviation of S(t)",
                          .style = Figure::Style::kLinesPoints,
                          .commands = {"set yrange [0:1]", level_line(0.5)},
                          .curves = mean,
                          .title = "(b) mean order"});
  Map map = phase_map(runs);
  sheet.panels.push_back({.x_title = axis_of("rods.area_fraction"),
                          .y_title = axis_of("rods.length"),
                          .commands = {"set cbrange [0:1]", "set size noratio", "set cblabel '⟨S⟩'"},
                          .curves = {transition_curve(runs)},
                          .title = "(c) phase diagram",
                          .map = std::move(map)});
  sheet.panels.push_back({.x_title = axis_of("rods.area_fraction"),
                          .y_title = "standard deviation of S(t)",
                          .style = Figure::Style::kLinesPoints,
                          .commands = {"set yrange [0:*]"},
                          .curves = spread,
                          .title = "(d) fluctuations of the order"});
  return sheet;
}

}  // namespace shaken::client
