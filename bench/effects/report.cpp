// SPDX-License-Identifier: MIT
#include "bench/effects/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/table.h"
#include "bench/picture.h"
#include "run/files/version.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string per_tick(std::int64_t impulses, const EngineSpeed& speed) {
  return fmt::format("{:.3g}", static_cast<double>(impulses) / static_cast<double>(speed.ticks));
}

}  // namespace

std::string as_text(const Conditions& conditions, const Case& scene, const std::vector<Saving>& savings) {
  std::vector<Row> rows{
      {"without", "same state %", "+-", "own state %", "+-", "rod-s/CPU-s", "plate/tick", "rod-rod/tick", "that is"}};
  std::string impossible;
  const auto percent = [](double ratio) { return fmt::format("{:.1f}", 100 * ratio); };
  for (const Saving& saving : savings) {
    if (!saving.impossible.empty()) {
      impossible += fmt::format("{}: {}\n", saving.effect, saving.impossible);
      continue;
    }
    const auto& same = saving.same_state;
    const Comparison& own = saving.own_state;
    rows.push_back({saving.effect, same ? percent(same->ratio()) : "-", same ? percent(same->error()) : "",
                    percent(own.ratio()), percent(own.error()), fmt::format("{:.1f}", own.speed.rate()),
                    per_tick(own.speed.plate_impulses, own.speed), per_tick(own.speed.rod_impulses, own.speed),
                    saving.neutral});
  }
  return fmt::format(
             "shaken {} on {}\n{}, N = {}, dt = {:.10g} us; states after {:.10g} simulated seconds; best of {} "
             "repetitions\n\nCPU time per rod-second without an effect, in % of that with everything on, taken in "
             "turn; "
             "errors are from the\nscatter of single repetitions. Same state: the next 4 vibrations of the rods with "
             "everything on, which is what\nit takes to compute the effect. Own state: after a warm-up without the "
             "effect, which also counts what its absence\nmakes of the rods. Impulses of rods with plates and with "
             "each "
             "other, per tick, and rates are of the own state.\n",
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
  const auto comparison_json = [](const std::optional<Comparison>& c) {
    return Json{{"cpu_ratio", c ? Json(c->ratio()) : Json()},
                {"cpu_ratio_error", c ? Json(c->error()) : Json()},
                {"rod_s_per_cpu_s", c ? Json(c->speed.rate()) : Json()},
                {"everything_rod_s_per_cpu_s", c ? Json(c->yardstick.rate()) : Json()},
                {"cpu_s", c ? Json(c->speed.cpu) : Json()},
                {"everything_cpu_s", c ? Json(c->yardstick.cpu) : Json()},
                {"ticks", c ? Json(c->speed.ticks) : Json()},
                {"plate_impulses", c ? Json(c->speed.plate_impulses) : Json()},
                {"rod_impulses", c ? Json(c->speed.rod_impulses) : Json()}};
  };
  for (const Saving& saving : savings) {
    if (!saving.impossible.empty()) {
      report["impossible"][saving.effect] = saving.impossible;
      continue;
    }
    report["rows"].push_back({{"without", saving.effect},
                              {"neutral", saving.neutral},
                              {"same_state", comparison_json(saving.same_state)},
                              {"own_state", comparison_json(saving.own_state)}});
  }
  return report;
}

void draw_savings(const std::filesystem::path& folder, const std::vector<Saving>& savings) {
  std::string data = "# effect left out  CPU time [% of everything on]: same state, error, own state, error\n";
  int n = 0;
  for (const Saving& saving : savings) {
    if (!saving.impossible.empty()) continue;
    std::string name = saving.effect;
    std::replace(name.begin(), name.end(), '_', ' ');
    const auto cells = [](const std::optional<Comparison>& c) {
      return c ? fmt::format(" {:.6g} {:.4g}", 100 * c->ratio(), 100 * c->error()) : std::string(" NaN NaN");
    };
    data += fmt::format("\"{}\"{}{}\n", name, cells(saving.same_state), cells(saving.own_state));
    ++n;
  }
  std::string script = gnuplot_prologue("effects", std::max(1100, 220 + 80 * n), 800);
  script += fmt::format(
      "set style fill solid 1\nset boxwidth 0.38\nset xtics rotate by 35 right scale 0\nset bmargin 9\n"
      "set logscale y\nset yrange [20:*]\nset xrange [-0.6:{}]\nset key above\n"
      "set ylabel 'CPU time without the effect (% of everything on)'\n"
      "set arrow from graph 0,first 100 to graph 1,first 100 nohead linecolor '#999999' dashtype 2\n"
      "plot 'effects.dat' using ($0-0.2):2:xtic(1) with boxes linecolor '#5ec962' title 'from the same state', "
      "'' using ($0+0.2):4 with boxes linecolor '#3b528b' title 'from its own state', "
      "'' using ($0-0.2):2:3 with yerrorbars pointtype 0 linecolor '#333333' notitle, "
      "'' using ($0+0.2):4:5 with yerrorbars pointtype 0 linecolor '#333333' notitle\n",
      n - 0.4);
  draw(folder, "effects", data, script);
}

}  // namespace shaken::bench
