// SPDX-License-Identifier: MIT
// Nematic order: where it sets in, how it fluctuates, on which box it depends, how far it reaches.
#include <cmath>

#include "study/figures.h"

namespace shaken::study {
namespace {

/// <S> on the plane of area fraction and rod length.
Map phase_map(const RunSet& runs) {
  Map map{.x = values_of(runs, kPacking), .y = values_of(runs, kLength)};
  for (const double length : map.y) {
    for (const double fraction : map.x) {
      const RunSet here = where(where(runs, kLength, length), kPacking, fraction);
      map.z.push_back(mean_scalar(here, "order.mean").value);
    }
  }
  return map;
}

/// Area fraction at which <S> passes 0.5, for every rod length that has one.
Curve transition_curve(const RunSet& runs) {
  Curve curve{.label = "⟨S⟩ = 0.5", .look = Curve::Look::kPoints};
  for (const auto& [length, phi] : transitions(runs, kLength)) {
    curve.x.push_back(phi.value);
    curve.y.push_back(length);
    curve.unsteady.push_back(phi.steady != true);
  }
  return curve;
}

/// The same in each box.
Curve transition_against_size(const RunSet& runs) {
  Curve curve;
  for (const auto& [side, phi] : transitions(runs, "box.side")) {
    curve.x.push_back(side);
    curve.y.push_back(phi.value);
    curve.y_error.push_back(phi.sem);
    curve.unsteady.push_back(phi.steady != true);
  }
  return curve;
}

Figure binder_panel(const RunSet& runs, const std::string& series, std::string y_title, std::string title) {
  return key_panel(kPacking, std::move(y_title), scalar_curves(runs, series, kPacking, "binder"), std::move(title),
                   {"set yrange [-0.2:1.1]", level_line(0), level_line(1)});
}

/// <S> against the packing, with the level at which order begins.
Figure mean_order_panel(std::vector<Curve> curves, std::string title, std::string y_title = "⟨S⟩") {
  return key_panel(kPacking, std::move(y_title), std::move(curves), std::move(title),
                   {"set yrange [0:1]", level_line(0.5)});
}

/// Each curve in units of its first point.
std::vector<Curve> relative(std::vector<Curve> curves) {
  for (Curve& curve : curves) {
    const double first = curve.y.empty() ? 1 : curve.y.front();
    for (double& y : curve.y) y /= first;
    for (double& error : curve.y_error) error /= first;
  }
  return curves;
}

/// The standard deviation of S(t) against the packing, a curve for each rod length, at the points of scalar_curves().
std::vector<Curve> spread_curves(const RunSet& runs) {
  std::vector<Curve> curves = scalar_curves(runs, kLength, kPacking, "order.mean");
  const std::vector<double> lengths = values_of(runs, kLength);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const RunSet column = where(runs, kLength, lengths[i]);
    for (std::size_t k = 0; k < curves[i].x.size(); ++k) {
      curves[i].y[k] = order_spread(where(column, kPacking, curves[i].x[k]));
    }
    curves[i].y_error.clear();
  }
  return curves;
}

}  // namespace

Sheet start_figure(const Material& material) {
  Sheet sheet{.title = "Rods as they lie, and how their order settles", .columns = 3};
  Letters letter;
  const RunSet& filmed = material.runs["movies"];
  const auto snapshots = [&](const RunSet& runs) {
    for (const double fraction : values_of(runs, kPacking)) {
      const RunSet here = where(runs, kPacking, fraction);
      sheet.panels.push_back(
          snapshot_panel(material, here, letter(label_of(here, kLength) + ", " + value_label(kPacking, fraction))));
    }
  };
  const double gap = 1.2;  // the paper's [mm]; films S4 and S5 have others
  const RunSet usual = where(filmed, "box.gap", gap);
  snapshots(with_extreme(usual, kLength, false));
  snapshots(with_extreme(usual, kLength, true));
  fill_row(sheet);
  const auto [shortest, longest, of_short, of_long] = BothLengths(material.runs["phases"]);
  sheet.panels.push_back(start_panel(longest, letter("from the aligned start" + of_long)));
  sheet.panels.push_back(start_panel(shortest, letter("from the aligned start" + of_short)));
  return sheet;
}

Sheet order_figure(const Material& material) {
  const RunSet& runs = material.runs["phases"];
  const std::vector<double> lengths = values_of(runs, kLength);
  // The paper's bars are the standard deviation of S(t), how far it swings, not the error of its mean.
  std::vector<Curve> mean = scalar_curves(runs, kLength, kPacking, "order.mean");
  const std::vector<Curve> spread = spread_curves(runs);
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i].y_error = spread[i].y;
  return {.title = "Nematic order",
          .panels = {mean_order_panel(mean, "(a) mean order", "⟨S⟩; bars: standard deviation of S(t)"),
                     {.x_title = axis_of(kPacking),
                      .y_title = axis_of(kLength),
                      .commands = {"set cbrange [0:1]", "set size noratio", "set cblabel '⟨S⟩'"},
                      .curves = {transition_curve(runs)},
                      .title = "(b) phase diagram",
                      .map = phase_map(runs)}}};
}

Sheet order_statistics_figure(const Material& material) {
  const RunSet& runs = material.runs["phases"];
  const RunSet longest = with_extreme(runs, kLength, true);
  return {.title = "Statistics of the order",
          .columns = 3,
          .panels = {
              {.x_title = "nematic order S",
               .y_title = "P[S]",
               .commands = {"set xrange [0:1]", "set yrange [0:*]"},
               .curves = array_curves(longest, kPacking, "/order/pdf/order", "/order/pdf/density"),
               .title = "(a) longest rods"},
              key_panel(kPacking, "standard deviation of S(t)", spread_curves(runs), "(b) fluctuations of the order"),
              binder_panel(runs, kLength, "Binder cumulant 2 − ⟨S^4⟩/⟨S^2⟩^2", "(c) 0 in disorder, 1 in order")}};
}

Sheet g2_figure(const Material& material) {
  const auto [shortest, longest, of_short, of_long] = BothLengths(material.runs["phases"]);
  const char* const title = "G_2(r) = ⟨cos 2({/Symbol q}_i − {/Symbol q}_j)⟩";
  return {.title = "Orientational correlation",
          .panels = {distance_panel(shortest, "g2", title, "(a) shortest rods" + of_short),
                     distance_panel(longest, "g2", title, "(b) longest rods" + of_long)}};
}

Sheet steady_state_figure(const Material& material) {
  const double length = 3.5;
  const RunSet small = where(material.runs["phases"], kLength, length);
  const RunSet longer = where(material.runs["layers"], kLength, length);
  Curve angle = array_curve(longer, "/order/time_s", "/order/director_rad", "director", 1);
  for (double& value : angle.y) value /= 1.5707963267948966;
  return {.title = "On the way to the steady state, l = 3.5 mm",
          .panels = {start_panel(small, "(a) from the aligned start"),
                     {.x_title = "time t (s)",
                      .y_title = "S; director's angle / 90°",
                      .commands = {"set xrange [0:*]"},
                      .curves = together({{array_curve(longer, "/order/time_s", "/order/order", "S", 0)}, {angle}}),
                      .title = "(b) larger box, area fraction 0.85: order and where it points"}}};
}

Sheet size_figure(const Material& material) {
  const RunSet runs = joined(material.runs["size"], with_extreme(material.runs["phases"], kLength, true));
  RunSet common;  // packings that were run in several boxes
  for (const double fraction : values_of(material.runs["size"], kPacking)) {
    common = joined(common, where(runs, kPacking, fraction));
  }
  const std::string sides = "set xtics (10, 20, 40, 80, 160)";
  return {.title = "Order against the size of the box",
          .panels = {mean_order_panel(scalar_curves(runs, "box.side", kPacking, "order.mean"), "(a) order"),
                     binder_panel(runs, "box.side", "Binder cumulant", "(b) Binder cumulant"),
                     key_panel("box.side", "⟨S⟩", positive(scalar_curves(common, kPacking, "box.side", "order.mean")),
                               "(c) order against size: level, a small power, or 1/L", {"set logscale xy", sides}),
                     key_panel("box.side", axis_of(kPacking), {transition_against_size(runs)},
                               "(d) where ⟨S⟩ passes 0.5", {"set logscale x", sides})}};
}

Sheet fluctuations_figure(const Material& material) {
  const auto panel = [&](const RunSet& runs, const char* array, std::string title) {
    Figure figure{.x_title = "mean number in a box ⟨N⟩",
                  .y_title = "standard deviation {/Symbol D}N",
                  .style = Figure::Style::kLinesPoints,
                  .commands = {"set logscale xy"},
                  .curves = positive(bare(array_curves(runs, kPacking, "/fluctuations/mean_n", array))),
                  .title = std::move(title)};
    Curve law = law_curve([](double n) { return std::sqrt(n); }, 1, 100, "√N: independent", figure.curves.size());
    figure.curves.push_back(std::move(law));
    return figure;
  };
  const RunSet longest = with_extreme(material.runs["phases"], kLength, true);
  const RunSet shortest = with_extreme(material.runs["phases"], kLength, false);
  const RunSet equilibrium = with_extreme(material.runs["equilibrium"], kLength, true);
  return {.title = "Number fluctuations",
          .panels = {
              panel(longest, "/fluctuations/std_n", "(a) longest rods"),
              panel(longest, "/fluctuations/std_n_without_map", "(b) longest rods, mean density map removed"),
              panel(shortest, "/fluctuations/std_n_without_map", "(c) shortest rods, map removed"),
              panel(equilibrium, "/fluctuations/std_n_without_map", "(d) longest rods in equilibrium, map removed")}};
}

Sheet equilibrium_figure(const Material& material) {
  Sheet sheet{.title = "Shaken against equilibrium"};
  Letters letter;
  for (const bool longest : {true, false}) {
    const RunSet shaken = with_extreme(material.runs["phases"], kLength, longest),
                 still = with_extreme(material.runs["equilibrium"], kLength, longest);
    const std::string point = still.empty() ? "" : ", " + label_of(still, kLength);
    const auto both = [&](const std::string& scalar) {
      return together({{scalar_curve(shaken, kPacking, scalar, "shaken", 0)},
                       {scalar_curve(still, kPacking, scalar, "equilibrium", 1)}});
    };
    sheet.panels.push_back(mean_order_panel(both("order.mean"), letter("order" + point)));
    sheet.panels.push_back(key_panel(kPacking, "D / D at the lowest packing", relative(both("diffusion_mm2_s")),
                                     letter("diffusion" + point)));
  }
  return sheet;
}

}  // namespace shaken::study
