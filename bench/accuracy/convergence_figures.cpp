// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/accuracy/report.h"
#include "bench/accuracy/style.h"
#include "bench/picture.h"

namespace shaken::bench {
namespace {

/// The cases, each once, with the indices of their measurements: one panel each.
struct Panel {
  const StartCase* start;
  std::vector<std::size_t> of;
};
std::vector<Panel> panels_of(const std::vector<Convergence>& measured) {
  std::vector<Panel> panels;
  for (std::size_t m = 0; m < measured.size(); ++m) {
    const auto same = std::find_if(panels.begin(), panels.end(),
                                   [&](const Panel& panel) { return panel.start == measured[m].start; });
    if (same == panels.end()) {
      panels.push_back({measured[m].start, {m}});
    } else {
      same->of.push_back(m);
    }
  }
  return panels;
}

/// One block per measurement, as gnuplot indexes them.
std::string data_of(const std::vector<Convergence>& measured) {
  std::string data =
      "# dt [us]  position [mm]  its quartiles  director [rad]  its quartiles  energy [1]  its quartiles  "
      "CPU time [us] scheduled  reference\n";
  for (const Convergence& of : measured) {
    data += fmt::format("# {}, {}\n", of.start->name, of.variant->name);
    for (const StepErrors& step : of.steps) {
      data += fmt::format("{:.10g}", 1e6 * step.dt);
      for (const Quartiles& error : step.errors) {
        data += fmt::format(" {:.6g} {:.6g} {:.6g}", error.median, error.lower, error.upper);
      }
      data += fmt::format(" {:.6g} {:.6g}\n", 1e6 * step.scheduled_cpu, 1e6 * step.reference_cpu);
    }
    data += "\n\n";
  }
  return data;
}

/// The last panel: a line of text per series, where it hides no data.
std::string legend_panel(const std::vector<std::string>& series) {
  std::string script =
      "unset label\nunset title\nunset xlabel\nunset ylabel\nunset border\nunset xtics\nunset ytics\nunset grid\n"
      "unset logscale\nset xrange [0:1]\nset yrange [0:1]\n";
  for (std::size_t k = 0; k < series.size(); ++k) {
    script += fmt::format("set label {} \"{}\" at graph 0,{:.3f} textcolor '{}' front\n", k + 1, series[k],
                          0.9 - 0.1 * static_cast<double>(k), colour(k));
  }
  return script + "plot NaN notitle\nunset multiplot\n";
}

constexpr std::array<const char*, kNorms> kColumns{"2:3:4", "5:6:7", "8:9:10"};

/// Errors against the step, a panel per case: the three norms of the first variant, or the positions of all.
std::string convergence_script(const std::vector<Convergence>& measured) {
  const std::vector<Panel> panels = panels_of(measured);
  std::string script = multiplot("convergence", panels.size() + 1);
  script += "set xlabel 'step (μs)' offset 0,0.6\nset xtics ('0.25' 0.25, '1' 1, '4' 4, '16' 16, '64' 64)\n";
  for (const Panel& panel : panels) {
    const bool one = panel.of.size() == 1;
    script += fmt::format("unset label\nset title '{}'\nset ylabel '{}'\n", panel.start->name,
                          one ? "error" : "error of position (mm)");
    std::string plot = "plot ";
    std::size_t series = 0;
    for (const std::size_t m : panel.of) {
      for (int n = 0; n < (one ? kNorms : 1); ++n, ++series) {
        const auto& fit = measured[m].orders[n];
        script +=
            fmt::format("set label {} \"{}\" at graph 0.97,{:.3f} right textcolor '{}' font ',13' front\n", series + 1,
                        fit ? fmt::format("order {:.2f}±{:.2f}", fit->order, fit->order_error) : "no order",
                        0.06 + 0.085 * static_cast<double>(series), colour(series));
        plot += fmt::format(
            "'convergence.dat' index {0} using ($1*{3:.2f}):{1} with yerrorbars pointtype 7 pointsize 0.9 linecolor "
            "'{2}' "
            "notitle, ",
            m, kColumns[n], colour(series), 0.94 + 0.06 * static_cast<double>(series));
        if (fit) {
          plot += fmt::format("{:.6g}*x**{:.6g} with lines linewidth 1 linecolor '{}' notitle, ",
                              fit->coefficient * std::pow(1e-6, fit->order), fit->order, colour(series));
        }
      }
    }
    // room below the data for the legend
    script +=
        fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [*:*]\nset offsets 0,0,0,0\n",
                    0.7e6 * measured[panel.of[0]].steps.front().dt, 1.4e6 * measured[panel.of[0]].steps.back().dt);
    double least = 1e300, most = 0;
    for (const std::size_t m : panel.of) {
      for (const StepErrors& step : measured[m].steps) {
        for (int n = 0; n < (one ? kNorms : 1); ++n) {
          if (step.errors[n].lower > 0) least = std::min(least, step.errors[n].lower);
          most = std::max(most, step.errors[n].upper);
        }
      }
    }
    const double share = 0.05 + 0.09 * static_cast<double>(series);
    script +=
        fmt::format("set yrange [{:.3g}:{:.3g}]\n", least * std::pow(least / most, share / (1 - share)), 2 * most);
    plot.resize(plot.size() - 2);
    script += plot + "\n";
  }
  std::vector<std::string> names;
  if (panels.front().of.size() == 1) {
    names = {"position (mm)", "director (rad)", "kinetic energy (relative)"};
  } else {
    for (const std::size_t m : panels.front().of) names.emplace_back(measured[m].variant->name);
  }
  return script + legend_panel(names);
}

/// Errors of position against CPU time, a panel per case, a line per variant and stepper.
std::string work_script(const std::vector<Convergence>& measured) {
  const std::vector<Panel> panels = panels_of(measured);
  std::string script = multiplot("work_precision", panels.size() + 1);
  script += "set xlabel 'CPU time (μs)' offset 0,0.6\nset format x '10^{%L}'\nset ylabel 'error of position (mm)'\n";
  for (const Panel& panel : panels) {
    script += fmt::format("unset label\nset title '{}, {:.3g} ms'\n", panel.start->name, 1e3 * panel.start->duration);
    std::string plot = "plot ";
    std::size_t series = 0;
    for (const std::size_t m : panel.of) {
      for (const bool scheduled : {true, false}) {
        if (!scheduled && m != panel.of[0]) continue;  // one shows how much the stepper matters
        plot += fmt::format(
            "'work_precision.dat' index {} using {}:2 with linespoints pointtype {} pointsize 0.9 linewidth 1.2 "
            "linecolor '{}' "
            "notitle, ",
            m, scheduled ? 11 : 12, scheduled ? 7 : 6, colour(series));
        ++series;
      }
    }
    plot.resize(plot.size() - 2);
    script += "set yrange [*:*]\n" + plot + "\n";
  }
  std::vector<std::string> names;
  for (const std::size_t m : panels.front().of) {
    names.push_back(std::string(measured[m].variant->name) + ", scheduled");
    if (m == panels.front().of[0]) names.push_back(std::string(measured[m].variant->name) + ", reference");
  }
  return script + legend_panel(names);
}

}  // namespace

void draw_convergence(const std::filesystem::path& folder, const std::vector<Convergence>& measured) {
  const std::string data = data_of(measured);
  draw(folder, "convergence", data, convergence_script(measured));
  draw(folder, "work_precision", data, work_script(measured));
}

}  // namespace shaken::bench
