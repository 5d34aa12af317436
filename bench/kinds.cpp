// SPDX-License-Identifier: MIT
// The scheduled stepper on each kind of scene.
#include <fmt/format.h>

#include "base/progress_line.h"
#include "bench/speed.h"

namespace shaken::bench {
namespace {

constexpr const char* kBase =
    R"({"rods": {"length": "4.5 mm", "area_fraction": 0.75}, "box": {"side": "41.865 mm"}, "time": {"step": "4 us"}})";

Json kind_row(const CountedWork& counted, const StepperSpeed& base) {
  const StepperSpeed& speed = counted.of.speed;
  const auto per_rod_second = [&](std::int64_t n) { return static_cast<double>(n) / speed.rod_seconds; };
  Json row{{"kind", counted.of.scene.label}};
  row.update(json_of(counted.of.scene));
  row["scheduled"] = json_of(speed);
  const Estimate cost = cpu_ratio(speed, base);
  row["relative_cost"] = cost.value;
  row["relative_cost_error"] = cost.sem;
  row["impulses_per_rod_second"] = {{"plates", per_rod_second(speed.plate_impulses)},
                                    {"walls", per_rod_second(speed.wall_impulses)},
                                    {"rods", per_rod_second(speed.rod_impulses)}};
  add_work(row, counted);
  row["phase_shares"] = phase_shares(counted.phases, counted.cpu);
  return row;
}

}  // namespace

const std::vector<SceneKind>& scene_kinds() {
  static const std::vector<SceneKind> kinds{
      {"apolar rods", R"({})"},
      {"dilute", R"({"rods": {"area_fraction": 0.45}})"},
      {"short", R"({"rods": {"length": "2.5 mm", "area_fraction": 0.60}})"},
      {"spheres", R"({"rods": {"length": "0.8 mm", "end_diameter": "0.8 mm", "beads": 1, "area_fraction": 0.50},
                      "box": {"side": "22.4 mm"}})"},
      {"two species", R"({"rods": {"area_fraction": 0.40}, "rods_2": {"length": "2.5 mm", "area_fraction": 0.20}})"},
      {"polar rods", R"({"rods": {"profile": "polar", "area_fraction": 0.60}})"},
      {"polar, annulus", R"({"rods": {"profile": "polar", "area_fraction": null, "count": 175},
                             "walls": {"arena": "annulus", "inner": "15 mm"}})"},
      {"disc", R"({"rods": {"area_fraction": 0.60}, "walls": {"arena": "disc"}})"},
      {"at instant", R"({"time": {"impacts": "at_instant"}})"},
      {"poisson", R"({"contacts": {"law": "poisson"}})"},
      {"energetic", R"({"contacts": {"law": "energetic"}})"},
      {"no friction", R"({"contacts": {"rod_rod": {"friction": 0}, "rod_base": {"friction": 0},
                                       "rod_lid": {"friction": 0}}})"},
      {"noise", R"({"plates": {"noise": 0.1}})"},
      {"shuffled", R"({"contacts": {"order": "shuffled"}})"},
      {"weak plates", R"({"plates": {"gamma": 0.8}, "box": {"side": "20 mm"}})"},
      {"plates at rest", R"({"plates": {"gamma": 0}, "box": {"side": "20 mm"}})"},
  };
  return kinds;
}

Case case_of(const SceneKind& kind, double warm_up) {
  nlohmann::json scene = nlohmann::json::parse(kBase);
  scene.merge_patch(nlohmann::json::parse(kind.patch));
  return case_of(std::move(scene), warm_up, kind.name);
}

std::vector<CountedWork> measure_kinds(std::vector<Contender> kinds, int repeat) {
  time_in_turn("measuring", kinds, repeat);
  ProgressLine progress("counting");
  std::vector<CountedWork> measured;
  for (const Contender& kind : kinds) {
    Simulation simulation = resumed(kind.scene, kind.state, kind.stepper);
    advance(simulation, kind.shorten_bound);
    measured.push_back(count_work(kind, simulation));
    progress.show(static_cast<double>(measured.size()) / static_cast<double>(kinds.size()));
  }
  return measured;
}

Report kinds_report(const Conditions& conditions, const std::vector<CountedWork>& measured) {
  Report report = report_under(conditions, "kinds", "kinds");
  for (const CountedWork& counted : measured)
    report.json["rows"].push_back(kind_row(counted, measured.front().of.speed));
  report.text += fmt::format(
      "\nThe scheduled stepper by kind of scene, in turn. Spread: median over best CPU time; cost: CPU time per "
      "rod-second\n"
      "relative to the first line. Impulses from plates, from side walls and between rods are per rod and simulated\n"
      "second. bench/kinds.cpp says by what the kinds differ from\n{}\n",
      kBase);
  report.text += table(report.rows(), {{"kind", "kind"},
                                       {"l mm", "length_mm", "{:.10g}"},
                                       {"phi", "area_fraction", "{:.2f}"},
                                       {"N", "n_rods"},
                                       {"rod-s/CPU-s", "scheduled/rod_s_per_cpu_s", "{:.1f}"},
                                       {"spread", "scheduled/spread", "{:.3f}"},
                                       {"cost", "relative_cost", "{:.3f}"},
                                       {"+-", "relative_cost_error", "{:.3f}"},
                                       {"plates", "impulses_per_rod_second/plates", "{:.0f}"},
                                       {"walls", "impulses_per_rod_second/walls", "{:.0f}"},
                                       {"rods", "impulses_per_rod_second/rods", "{:.0f}"},
                                       {"ns/impulse", "scheduled/ns_per_impulse", "{:.0f}"},
                                       {"bytes/rod", "scheduled/bytes_per_rod", "{:.0f}"}});
  const std::vector<Column> scene{{"kind", "kind"}};
  report.text += phases_text(report.rows(), scene);
  report.text += work_text(report.rows(), scene);
  return report;
}

}  // namespace shaken::bench
