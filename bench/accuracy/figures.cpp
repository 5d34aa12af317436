// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/observables.h"

namespace shaken::bench {
namespace {

constexpr double kShown = 0.5;  ///< largest error of a velocity that is drawn [mm/s]

const std::vector<std::string> kLogLog{"set logscale xy", "set format y '10^{%L}'"};
const std::vector<std::string> kStepTics{"set xtics (0.25, 1, 4, 16, 64)"};
constexpr const char* kZeroLine = "set xzeroaxis linetype 1 linecolor '#333333' linewidth 0.7";

/// The 1 % that is looked for.
constexpr const char* kBand =
    "set object 1 rectangle from graph 0, first -1 to graph 1, first 1 fillcolor '#eeeeee' fillstyle solid noborder "
    "behind";

/// The same, of absolute values on a logarithmic scale.
constexpr const char* kBelow =
    "set object 1 rectangle from graph 0, graph 0 to graph 1, first 1 fillcolor '#eeeeee' fillstyle solid noborder "
    "behind";

std::vector<std::string> joined(std::vector<std::string> commands, const std::vector<std::string>& more) {
  commands.insert(commands.end(), more.begin(), more.end());
  return commands;
}

/// Rows that are alike in some members, as one series each, in the order in which the series begin.
std::vector<Json> series_of(const Json& rows, const std::vector<std::string>& members) {
  std::vector<Json> series;
  std::map<std::string, std::size_t> known;
  for (const Json& row : rows) {
    std::string key;
    for (const std::string& member : members) key += member_of(row, member).dump() + " ";
    const auto [at, is_new] = known.emplace(key, series.size());
    if (is_new) series.push_back(Json::array());
    series[at->second].push_back(row);
  }
  return series;
}

/// The row that is like `row` in these members; null if there is none.
Json like(const Json& rows, const Json& row, const std::vector<std::string>& members) {
  for (const Json& other : rows) {
    bool same = true;
    for (const std::string& member : members) same = same && member_of(other, member) == member_of(row, member);
    if (same) return other;
  }
  return {};
}

Curve coloured(Curve curve, std::size_t colour, Curve::Look look = Curve::Look::kAsFigure) {
  curve.colour = colour;
  curve.look = look;
  return curve;
}

/// y = f(x) at those places of `curve` that are within [from, to], as the law that its points follow there.
template <class Law>
Curve law_of(const Curve& curve, const Law& law, double from = 0, double to = 1e300) {
  Curve line{.colour = curve.colour, .look = Curve::Look::kDashes};
  for (const double x : curve.x) {
    if (x < from || x > to) continue;
    line.x.push_back(x);
    line.y.push_back(law(x));
  }
  return line;
}

/// The medians of one norm with their quartiles, and the power law that they follow.
void add_errors(Figure& panel, const Json& series, const Json& order, const std::string& norm,
                const std::string& label) {
  const std::size_t colour = static_cast<std::size_t>(
      std::count_if(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) { return !curve.label.empty(); }));
  const Column step{"", "dt_s", "", 1e6};
  const Json& fit = order.at(norm);
  const bool is_fitted = !fit.at("order").is_null();
  const std::string found =
      is_fitted ? fmt::format("order {:.2f}±{:.2f}", fit.at("order").get<double>(), fit.at("order_error").get<double>())
                : "no order";
  const Curve median =
      coloured(curve(series, step, {label + ": " + found, "error/" + norm + "/median"}), colour, Curve::Look::kPoints);
  panel.curves.push_back(median);
  for (const char* quartile : {"/lower", "/upper"}) {
    panel.curves.push_back(
        coloured(curve(series, step, {"", "error/" + norm + quartile}), colour, Curve::Look::kDashes));
  }
  if (!is_fitted) return;
  Curve line = law_of(median, [&](double us) {
    return fit.at("coefficient").get<double>() * std::pow(1e-6 * us, fit.at("order").get<double>());
  });
  line.look = Curve::Look::kLine;
  panel.curves.push_back(std::move(line));
}

/// "ℓ 4.5 mm, φ 0.75, instant"
std::string scene_text(const Json& series) {
  const Json& row = series.at(0);
  const std::string variant = row.at("variant");
  return fmt::format("ℓ {:g} mm, φ {:g}{}", row.at("length_mm").get<double>(), row.at("area_fraction").get<double>(),
                     variant == variants().front().name ? "" : ", " + variant);
}

/// Whether the limit is known well enough for a bias relative to it to mean anything.
bool is_resolved(const Json& limit) {
  return !limit.is_null() && limit.at("/limit/sem"_json_pointer).get<double>() <
                                 0.25 * std::abs(limit.at("/limit/value"_json_pointer).get<double>());
}

Column bias_of(const std::string& observable, const std::string& label) {
  return {label, observable + "/bias", "", 100, observable + "/bias_error"};
}

/// Bias of every observable with a limit against the step; a panel each, a series per scene.
void draw_bias(const std::filesystem::path& folder, const std::vector<Json>& steps, const Json& limits) {
  Sheet sheet{.name = "bias", .columns = 4};
  for (const ObservableInfo& info : kObservableInfo) {
    if (!info.has_limit) continue;
    const std::string name = info.name;
    Figure panel{.x_title = "step (μs)", .y_title = "bias (%)", .style = Figure::Style::kPoints, .title = info.title};
    panel.commands =
        joined({"set logscale x 2", "set xrange [0.7:90]", "set yrange [*<-1.5:1.5<*]", kZeroLine, kBand}, kStepTics);
    for (std::size_t s = 0; s < steps.size(); ++s) {
      Json wanted = steps[s].at(0);
      wanted["observable"] = name;
      const Json limit = like(limits, wanted, {"length_mm", "variant", "observable"});
      if (!is_resolved(limit)) continue;
      Curve points = coloured(curve(steps[s], {"", "value"}, bias_of(name, scene_text(steps[s]))), s);
      const double slope = limit.at("/slope_per_us/value"_json_pointer).get<double>() /
                           limit.at("/limit/value"_json_pointer).get<double>();
      panel.curves.push_back(law_of(
          points, [&](double us) { return 100 * slope * us; }, 0, kLinear * points.x[0]));
      panel.curves.push_back(std::move(points));
    }
    sheet.panels.push_back(std::move(panel));
  }
  draw(sheet, folder);
}

/// What `draw_cost` sums up in one number: the averages whose biases are known to much better than 1 %.
constexpr std::array<Observable, 5> kAverages{Observable::kTemperatureXy, Observable::kTemperatureZ,
                                              Observable::kRotation, Observable::kTilt, Observable::kDisplacement};

/// The bound that all `observables` are below: their largest |bias| with two standard errors to spare [%].
template <class Observables>
double bound_of(const Json& row, const Observables& observables) {
  double bound = 0;
  for (const Observable observable : observables) {
    const Json& of = row.at(kObservableInfo[static_cast<std::size_t>(observable)].name);
    bound = std::max(bound, 100 * (std::abs(of.at("bias").get<double>()) + 2 * of.at("bias_error").get<double>()));
  }
  return bound;
}

/// "[2:30]" of a logarithmic axis, with room for labels beyond the values of all curves.
std::string range_of(const std::vector<Curve>& curves, std::vector<double> Curve::*values) {
  double least = 1e300, most = 0;
  for (const Curve& curve : curves) {
    for (const double value : curve.*values) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  return fmt::format("[{:.4g}:{:.4g}]", least / 1.5, most * 1.5);
}

/// Bias against CPU time: a column of panels per rod, a series per variant, each point with its step. Above, the
/// averages; below, the rods just hit.
void draw_cost(const std::filesystem::path& folder, const Json& rows) {
  const std::vector<Json> rods = series_of(rows, {"length_mm"});
  Sheet sheet{.name = "cost", .columns = static_cast<int>(rods.size())};
  for (const bool hit : {false, true}) {
    for (const Json& rod : rods) {
      Figure panel{.x_title = "CPU time (ms per rod and simulated second)",
                   .y_title = "|bias| + 2 standard errors (%); steps in μs",
                   .style = Figure::Style::kLinesPoints,
                   .title = fmt::format("ℓ {:g} mm, φ {:g}: {}", rod.at(0).at("length_mm").get<double>(),
                                        rod.at(0).at("area_fraction").get<double>(),
                                        hit ? "rods just hit" : "temperatures, tilt, displacement")};
      panel.commands = {kBelow, "set logscale xy", "set ytics (0.5, 1, 2, 5, 10, 20)",
                        "set xtics (1, 2, 3, 5, 10, 20, 50)"};
      const std::vector<Json> of_variants = series_of(rod, {"variant"});
      for (const Json& series : of_variants) {
        Curve points{.label = text_of(series.at(0), "variant"), .colour = panel.curves.size()};
        const std::string label =
            fmt::format("center offset 0,{} textcolor '{}' font ',14'", points.colour == 0 ? 0.8 : -0.8,
                        curve_colour(points.colour, of_variants.size()));
        for (const Json& row : series) {
          points.x.push_back(1e3 * row.at("cpu_s_per_rod_s").get<double>());
          points.y.push_back(hit ? bound_of(row, std::array{Observable::kHit}) : bound_of(row, kAverages));
          panel.commands.push_back(fmt::format("set label '{:g}' at {:.6g},{:.6g} {}", row.at("value").get<double>(),
                                               points.x.back(), points.y.back(), label));
        }
        panel.curves.push_back(std::move(points));
      }
      panel.commands.push_back("set xrange " + range_of(panel.curves, &Curve::x));
      panel.commands.push_back("set yrange " + range_of(panel.curves, &Curve::y));
      sheet.panels.push_back(std::move(panel));
    }
  }
  draw(sheet, folder);
}

/// v_along(n_z) at every other step, a panel per scene.
void draw_tilt(const std::filesystem::path& folder, const std::vector<Json>& steps, const Json& tilt) {
  Sheet sheet{.name = "tilt", .columns = 2};
  for (const Json& series : steps) {
    Figure panel{.x_title = "tilt n_z", .y_title = "v along the rod (mm/s)", .title = scene_text(series)};
    panel.commands = {"set xrange [-0.4:0.4]", "set xtics 0.2", kZeroLine};
    for (std::size_t p = 0; p < series.size(); p += 2) {
      const Json at_step = like(tilt, series[p], {"length_mm", "variant", "knob", "value"});
      Curve points{.label = fmt::format("{:g} μs", series[p].at("value").get<double>()), .colour = p / 2};
      for (std::size_t b = 0; b < at_step.at("n_z").size(); ++b) {
        const double error = at_step.at("v_along_sem")[b].get<double>();
        if (!(error < kShown)) continue;  // met so seldom that it hides the others
        points.x.push_back(at_step.at("n_z")[b].get<double>());
        points.y.push_back(at_step.at("v_along")[b].get<double>());
        points.y_error.push_back(error);
      }
      panel.curves.push_back(std::move(points));
    }
    sheet.panels.push_back(std::move(panel));
  }
  draw(sheet, folder);
}

/// Differences from the most accurate value, for the knobs that change the model: a panel per knob.
void draw_model(const std::filesystem::path& folder, const std::vector<Json>& model) {
  Sheet sheet{.name = "model", .columns = 2};
  for (const Json& series : model) {
    const bool pitch = text_of(series.at(0), "knob") == kPitchKnob.name;
    Figure panel{.x_title = pitch ? "bead pitch (mm)" : "passes over the contacts of a tick",
                 .y_title = "difference (%)",
                 .style = Figure::Style::kLinesPoints};
    panel.title = fmt::format("{}, against {:g}{}", scene_text(series), series.at(0).at("value").get<double>(),
                              pitch ? " mm" : " passes");
    panel.commands = {"set logscale x", pitch ? "set xtics (0.15,0.2,0.3,0.45,0.6)" : "set xtics (1,2,4,8)", kZeroLine};
    for (const ObservableInfo& info : kObservableInfo) {
      if (!info.has_limit || info.name == std::string("drift")) continue;  // too noisy to be shown with the others
      panel.curves.push_back(
          coloured(curve(series, {"", "value"}, bias_of(info.name, info.title)), panel.curves.size()));
    }
    sheet.panels.push_back(std::move(panel));
  }
  draw(sheet, folder);
}

}  // namespace

void draw_convergence(const std::filesystem::path& folder, const Report& report) {
  Sheet errors{.name = "convergence", .columns = 4};
  Sheet work{.name = "work_precision", .columns = 4};
  for (const Json& of_case : series_of(report.rows(), {"case"})) {
    const std::vector<Json> of_variants = series_of(of_case, {"variant"});
    const bool one = of_variants.size() == 1;
    const std::string name = text_of(of_case.at(0), "case");
    Figure error{.x_title = "step (μs)", .y_title = one ? "error" : "error of position (mm)", .title = name};
    error.commands = joined(kLogLog, kStepTics);
    Figure against_time{.x_title = "CPU time (μs)",
                        .y_title = "error of position (mm)",
                        .style = Figure::Style::kLinesPoints,
                        .title = fmt::format("{}, {:.3g} ms", name, 1e3 * of_case[0].at("duration_s").get<double>())};
    against_time.commands = joined(kLogLog, {"set format x '10^{%L}'"});
    for (const Json& series : of_variants) {
      const std::string variant = text_of(series.at(0), "variant");
      const Json order = like(report.json.at("orders"), series.at(0), {"case", "variant"});
      if (one) {
        add_errors(error, series, order, "position", "position (mm)");
        add_errors(error, series, order, "director", "director (rad)");
        add_errors(error, series, order, "energy", "kinetic energy");
      } else {
        add_errors(error, series, order, "position", variant);
      }
      for (const char* stepper : {"scheduled", "reference"}) {
        // one variant shows how much the stepper matters
        if (stepper[0] == 'r' && &series != &of_variants.front()) continue;
        against_time.curves.push_back(coloured(curve(series, {"", stepper + std::string("_cpu_s"), "", 1e6},
                                                     {variant + ", " + stepper, "error/position/median"}),
                                               against_time.curves.size()));
      }
    }
    errors.panels.push_back(std::move(error));
    work.panels.push_back(std::move(against_time));
  }
  draw(errors, folder);
  draw(work, folder);
}

void draw_statistics(const std::filesystem::path& folder, const Report& report) {
  std::vector<Json> steps, model;
  for (Json& series : series_of(report.rows(), {"length_mm", "variant", "knob"})) {
    (text_of(series.at(0), "knob") == kStepKnob.name ? steps : model).push_back(std::move(series));
  }
  if (!steps.empty()) {
    draw_bias(folder, steps, report.json.at("limits"));
    draw_tilt(folder, steps, report.json.at("tilt"));
    Json rows = Json::array();
    for (const Json& series : steps) rows.insert(rows.end(), series.begin(), series.end());
    const bool has_limits = !report.json.at("limits").empty();  // one step alone has no bias
    if (has_limits && series_of(rows, {"variant"}).size() > 1) draw_cost(folder, rows);
  }
  if (!model.empty()) draw_model(folder, model);
}

void draw_order_error(const std::filesystem::path& folder, const Report& report) {
  Sheet sheet{.name = "error", .columns = 2};
  for (const bool cpu : {false, true}) {
    Figure panel{.x_title = cpu ? "CPU time (s)" : "simulated time T (s)",
                 .y_title = "statistical error of S",
                 .style = Figure::Style::kPoints,
                 .title = cpu ? "against CPU time" : "against simulated time"};
    panel.commands = joined(kLogLog, {"set format x '10^{%L}'"});
    for (const Json& box : report.rows()) {
      const double tau = box.at("tau_s").get<double>();
      // time on the axis per simulated second
      const double scale = cpu ? box.at("n_rods").get<double>() * box.at("cpu_s_per_rod_s").get<double>() : 1;
      Curve points{.label = fmt::format("L {:g} mm, τ {:.2g} s", box.at("side_mm").get<double>(), tau),
                   .colour = panel.curves.size() / 2,
                   .y = box.at("sem").get<std::vector<double>>(),
                   .y_error = box.at("sem_error").get<std::vector<double>>()};
      for (const double time : box.at("stretch_s").get<std::vector<double>>()) points.x.push_back(time * scale);
      const double c = box.at(box.at("c").is_null() ? "std" : "c").get<double>();
      panel.curves.push_back(law_of(
          points, [&](double x) { return c * std::sqrt(2 * tau * scale / x); }, 2 * tau * scale));
      panel.curves.push_back(std::move(points));
    }
    sheet.panels.push_back(std::move(panel));
  }
  draw(sheet, folder);
}

}  // namespace shaken::bench
