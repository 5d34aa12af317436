// SPDX-License-Identifier: MIT
#include "bench/effects/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/picture.h"
#include "bench/table.h"
#include "run/files/version.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string per_tick(std::int64_t impulses, const EngineSpeed& speed) {
  return fmt::format("{:.3g}", static_cast<double>(impulses) / static_cast<double>(speed.ticks));
}

}  // namespace

std::string as_text(const Conditions& conditions, const Case& scene, const std::vector<Saving>& savings) {
  std::vector<Row> rows{{"without", "CPU %", "+-", "rod-s/CPU-s", "plate/tick", "rod-rod/tick", "that is"}};
  std::string impossible;
  for (const Saving& saving : savings) {
    if (!saving.impossible.empty()) {
      impossible += fmt::format("{}: {}\n", saving.effect, saving.impossible);
      continue;
    }
    const Comparison& c = saving.comparison;
    rows.push_back({saving.effect, fmt::format("{:.1f}", 100 * c.ratio()), fmt::format("{:.1f}", 100 * c.error()),
                    fmt::format("{:.1f}", c.speed.rate()), per_tick(c.speed.plate_impulses, c.speed),
                    per_tick(c.speed.rod_impulses, c.speed), saving.neutral});
  }
  return fmt::format(
             "shaken {} on {}\n{}, N = {}, dt = {:.10g} us; each scene after {:.10g} simulated seconds of its own; "
             "best "
             "of {} repetitions\n\nCPU time per rod-second without an effect, in % of that with everything on; the two "
             "were taken in turn. Its\nerror is from the scatter of single repetitions. Impulses of rods with plates "
             "and with each other, per tick.\n",
             run::version(), describe(conditions.machine), scene.label(), scene.system().n_rods, 1e6 * scene.dt,
             conditions.warm_up, conditions.effort.repeat) +
         aligned(rows) + (impossible.empty() ? "" : "\nNot possible:\n" + impossible);
}

Json as_json(const Conditions& conditions, const Case& scene, const std::vector<Saving>& savings) {
  Json report{{"bench", "effects"},
              {"version", run::version()},
              {"machine", to_json(conditions.machine)},
              {"warm_up_s", conditions.warm_up},
              {"repeat", conditions.effort.repeat},
              {"length_mm", scene.length},
              {"area_fraction", scene.area_fraction},
              {"side_mm", scene.side},
              {"n_rods", scene.system().n_rods},
              {"dt_s", scene.dt},
              {"rows", Json::array()},
              {"impossible", Json::object()}};
  for (const Saving& saving : savings) {
    if (!saving.impossible.empty()) {
      report["impossible"][saving.effect] = saving.impossible;
      continue;
    }
    const Comparison& c = saving.comparison;
    report["rows"].push_back({{"without", saving.effect},
                              {"neutral", saving.neutral},
                              {"cpu_ratio", c.ratio()},
                              {"cpu_ratio_error", c.error()},
                              {"rod_s_per_cpu_s", c.speed.rate()},
                              {"everything_rod_s_per_cpu_s", c.yardstick.rate()},
                              {"cpu_s", c.speed.cpu},
                              {"everything_cpu_s", c.yardstick.cpu},
                              {"ticks", c.speed.ticks},
                              {"plate_impulses", c.speed.plate_impulses},
                              {"rod_impulses", c.speed.rod_impulses}});
  }
  return report;
}

void draw_savings(const std::filesystem::path& folder, const std::vector<Saving>& savings) {
  std::string data = "# effect left out  CPU time [% of everything on]  error\n";
  int n = 0;
  for (const Saving& saving : savings) {
    if (!saving.impossible.empty()) continue;
    std::string name = saving.effect;
    std::replace(name.begin(), name.end(), '_', ' ');
    data +=
        fmt::format("\"{}\" {:.6g} {:.4g}\n", name, 100 * saving.comparison.ratio(), 100 * saving.comparison.error());
    ++n;
  }
  std::string script = gnuplot_prologue("effects", 1200, 800);
  script += fmt::format(
      "set style fill solid 1\nset boxwidth 0.6\nset xtics rotate by 35 right scale 0\nset bmargin 8\n"
      "set yrange [0:*]\nset xrange [-0.6:{}]\nset ylabel 'CPU time without it (%)'\n"
      "set arrow from graph 0,first 100 to graph 1,first 100 nohead linecolor '#999999' dashtype 2\n"
      "plot 'effects.dat' using 0:2:xtic(1) with boxes linecolor '#3b528b' notitle, "
      "'' using 0:2:3 with yerrorbars pointtype 0 linecolor '#333333' notitle\n",
      n - 0.4);
  draw(folder, "effects", data, script);
}

}  // namespace shaken::bench
