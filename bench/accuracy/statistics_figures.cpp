// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "bench/accuracy/report.h"
#include "bench/accuracy/style.h"
#include "bench/picture.h"

namespace shaken::bench {
namespace {

/// Titles as people write them.
constexpr std::array<const char*, kObservables> kTitles{"temperature in the plane",
                                                        "temperature upright",
                                                        "temperature of rotation",
                                                        "order S",
                                                        "rms tilt n_z",
                                                        "drift against the tilt",
                                                        "square displacement in 20.7 ms",
                                                        "share of rods hit within 64 μs",
                                                        "impulses between rods",
                                                        "impulses from plates"};

constexpr double kShown = 0.5;  ///< largest error of a velocity that is drawn [mm/s]

std::vector<const Statistics*> of_knob(const std::vector<Statistics>& measured, Knob knob) {
  std::vector<const Statistics*> some;
  for (const Statistics& of : measured) {
    if (of.task.knob == knob) some.push_back(&of);
  }
  return some;
}

std::string scene_text(const Statistics& of) {
  return fmt::format("ℓ {:g} mm, φ {:g}{}", of.task.scene.length, of.task.scene.area_fraction,
                     of.task.variant == &variants().front() ? "" : std::string(", ") + of.task.variant->name);
}

/// One block per series: value, cost, then bias and its error of every observable [%].
std::string data_of(const std::vector<const Statistics*>& series) {
  std::string data = "# value, CPU-s per rod-s, then bias and error in %: ";
  for (const ObservableInfo& info : kObservableInfo) data += fmt::format("{} ", info.name);
  data += "\n";
  for (const Statistics* of : series) {
    for (const StatisticsPoint& point : of->points) {
      data += fmt::format("{:.10g} {:.6g}", point.value, point.cpu_per_rod_second);
      for (const Mean& bias : point.biases) data += fmt::format(" {:.6g} {:.6g}", 100 * bias.value, 100 * bias.sem);
      data += "\n";
    }
    data += "\n\n";
  }
  return data;
}

/// Whether the limit is known well enough for a bias relative to it to mean anything.
bool is_resolved(const Statistics& of, int observable) {
  const auto& limit = of.limits[observable];
  return limit && limit->at_zero.sem < 0.25 * std::abs(limit->at_zero.value);
}

/// Bias of every observable with a limit against the step; a panel each, a series per scene.
void draw_bias(const std::filesystem::path& folder, const std::vector<const Statistics*>& series) {
  std::string script = multiplot("bias", 8);
  script += "unset logscale\nset logscale x\nset format y '%g'\nset xlabel 'step (μs)' offset 0,0.6\n";
  script += "set xtics (1,2,4,8,16,32,64)\nset xzeroaxis linetype 1 linecolor '#333333' linewidth 0.7\n";
  const auto& points = series.front()->points;
  script += fmt::format("set xrange [{:.4g}:{:.4g}]\n", 0.7 * points.front().value, 1.4 * points.back().value);
  for (int o = 0; o < kObservables; ++o) {
    if (!kObservableInfo[o].has_limit) continue;
    // the 1 % that is looked for, as a band; the legend stands above the data
    double low = -1.5, high = 1.5;
    for (const Statistics* of : series) {
      if (!is_resolved(*of, o)) continue;
      for (const StatisticsPoint& point : of->points) {
        low = std::min(low, 100 * (point.biases[o].value - point.biases[o].sem));
        high = std::max(high, 100 * (point.biases[o].value + point.biases[o].sem));
      }
    }
    const double share = 0.04 + 0.085 * static_cast<double>(series.size());
    script += fmt::format("unset label\nunset object\nset title '{}'\nset ylabel 'bias (%)'\n", kTitles[o]);
    script += fmt::format("set yrange [{:.4g}:{:.4g}]\n", low - 0.05 * (high - low),
                          high + (high - low) * share / (1 - share));
    script +=
        "set object 1 rectangle from graph 0, first -1 to graph 1, first 1 fillcolor '#eeeeee' fillstyle solid "
        "noborder behind\n";
    std::string plot = "plot 1/0 notitle, ";
    for (std::size_t s = 0; s < series.size(); ++s) {
      if (!is_resolved(*series[s], o)) continue;
      script += fmt::format("set label {} \"{}\" at graph 0.04,{:.3f} textcolor '{}' font ',13' front\n", s + 1,
                            scene_text(*series[s]), 0.95 - 0.085 * static_cast<double>(s), colour(s));
      plot += fmt::format(
          "'bias.dat' index {} using ($1*{:.2f}):{}:{} with yerrorbars pointtype 7 linecolor '{}' notitle, ", s,
          1 + 0.08 * static_cast<double>(s), 3 + 2 * o, 4 + 2 * o, colour(s));
      if (const auto& limit = series[s]->limits[o]) {
        plot += fmt::format("{:.6g}*x with lines linewidth 1 linecolor '{}' notitle, ",
                            100 * limit->slope.value / limit->at_zero.value, colour(s));
      }
    }
    plot.resize(plot.size() - 2);
    script += plot + "\n";
  }
  draw(folder, "bias", data_of(series), script + "unset multiplot\n");
}

/// One line per bin that was met often enough not to hide the others behind its error.
std::string tilt_rows(const analysis::TiltCurve& curve) {
  std::string rows;
  for (std::size_t b = 0; b < curve.n_z.size(); ++b) {
    if (!(curve.v_along_sem[b] < kShown)) continue;
    rows += fmt::format("{:.4g} {:.5g} {:.3g}\n", curve.n_z[b], curve.v_along[b], curve.v_along_sem[b]);
  }
  return rows;
}

/// v_along(n_z) at several steps, a panel per scene.
void draw_tilt(const std::filesystem::path& folder, const std::vector<const Statistics*>& series) {
  std::string data = "# n_z  v_along  error [mm/s], a block per scene and step\n";
  std::string script = multiplot("tilt", series.size());
  script +=
      "unset logscale\nset format y '%g'\nset xlabel 'tilt n_z' offset 0,0.6\nset ylabel 'v along the rod (mm/s)'\n";
  script += "set xrange [-0.4:0.4]\nset xzeroaxis linetype 1 linecolor '#333333' linewidth 0.7\nset xtics 0.2\n";
  std::size_t block = 0;
  for (const Statistics* of : series) {
    script += fmt::format("unset label\nset title '{}'\nset yrange [-1:1]\n", scene_text(*of));
    std::string plot;
    for (std::size_t p = 0, shown = 0; p < of->points.size(); p += 2) {
      const std::string rows = tilt_rows(of->points[p].tilt);
      if (rows.empty()) continue;
      data += rows + "\n\n";
      script += fmt::format(
          "set yrange [*:*]\nset offsets 0,0,graph 0.4,0\nset label {} \"{:g} μs\" at graph 0.97,{:.3f} right "
          "textcolor '{}' font ',13' front\n",
          shown + 1, of->points[p].value, 0.95 - 0.075 * static_cast<double>(shown), colour(shown));
      plot += fmt::format(
          ", 'tilt.dat' index {0} using 1:2:3 with yerrorbars pointtype 7 pointsize 0.8 linewidth 0.8 linecolor '{1}' "
          "notitle, "
          "'' index {0} using 1:2 with lines linewidth 0.8 linecolor '{1}' notitle",
          block, colour(shown));
      ++block;
      ++shown;
    }
    script += "plot NaN notitle" + plot + "\n";
  }
  draw(folder, "tilt", data, script + "unset multiplot\n");
}

/// Differences from the most accurate value, for the knobs that change the model: a panel per knob.
void draw_model(const std::filesystem::path& folder, const std::vector<const Statistics*>& series) {
  std::string script = gnuplot_prologue("model", 1500, 640);
  script += "set multiplot layout 1,2 margins screen 0.065,0.755,0.13,0.92 spacing screen 0.075,0.1\n";
  script += "set xzeroaxis linetype 1 linecolor '#333333' linewidth 0.7\nset ylabel 'difference (%)'\n";
  for (std::size_t s = 0; s < series.size(); ++s) {
    const bool pitch = series[s]->task.knob == Knob::kPitch;
    const auto& points = series[s]->points;
    const double first = points.front().value, last = points.back().value;
    script += fmt::format("set logscale x\nset xlabel '{}'\nset xrange [{:.4g}:{:.4g}]\nset xtics ({})\n",
                          pitch ? "bead pitch (mm)" : "passes over the contacts of a tick", 0.8 * std::min(first, last),
                          1.25 * std::max(first, last), pitch ? "0.15,0.2,0.3,0.45,0.6" : "1,2,4,8");
    script += fmt::format("set title '{}, against {:g}{}'\n", scene_text(*series[s]), first, pitch ? " mm" : " passes");
    std::string plot = "plot ";
    int line = 0;
    for (int o = 0; o < kObservables; ++o) {
      if (!kObservableInfo[o].has_limit || o == static_cast<int>(Observable::kDrift)) continue;
      if (s == 0) {
        script += fmt::format("set label {} \"{}\" at screen 0.78,{:.3f} textcolor '{}' font ',13'\n", line + 1,
                              kTitles[o], 0.85 - 0.07 * line, colour(static_cast<std::size_t>(line)));
      }
      plot += fmt::format(
          "'model.dat' index {} using ($1*{:.3f}):{}:{} with yerrorlines pointtype 7 pointsize 0.9 linewidth 0.9 "
          "linecolor '{}' notitle, ",
          s, 1 + 0.012 * (line - 3), 3 + 2 * o, 4 + 2 * o, colour(static_cast<std::size_t>(line)));
      ++line;
    }
    plot.resize(plot.size() - 2);
    script += plot + "\nunset label\n";
  }
  draw(folder, "model", data_of(series), script + "unset multiplot\n");
}

}  // namespace

void draw_statistics(const std::filesystem::path& folder, const std::vector<Statistics>& measured) {
  const auto steps = of_knob(measured, Knob::kStep);
  if (!steps.empty()) {
    draw_bias(folder, steps);
    draw_tilt(folder, steps);
  }
  auto model = of_knob(measured, Knob::kPitch);
  for (const Statistics* of : of_knob(measured, Knob::kSweeps)) model.push_back(of);
  if (!model.empty()) draw_model(folder, model);
}

}  // namespace shaken::bench
