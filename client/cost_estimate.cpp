#include "client/cost_estimate.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/failure.h"
#include "base/files.h"
#include "base/keys/units.h"
#include "base/process.h"
#include "base/scratch_folder.h"
#include "base/table.h"
#include "base/text.h"
#include "scene/canonical.h"
#include "scene/keys/accuracy_levels.h"
#include "scene/keys/derived.h"

namespace shaken::client {
namespace {

constexpr const char* kAsWritten = "as written";

/// What shaken-worker says of one run.
Json probe(const scene::RunPlan& plan, const std::string& label, double cpu, const std::string& from) {
  const ScratchFolder folder;
  const std::string scene = folder.path() / "scene.json", answer = folder.path() / "cost.json";
  done_or_fail(write_file(scene, scene::to_json(plan).dump()));
  std::vector<std::string> command{
      sibling_program("shaken-worker").string(), scene, "--probe", answer, "--probe-cpu", fmt::format("{}", cpu)};
  if (!from.empty()) command.insert(command.end(), {"--probe-from", from});
  const Captured result = run_captured(command);
  if (result.exit_code != 0) {
    std::string words = result.output;
    words.erase(words.find_last_not_of('\n') + 1);
    throw Failure(result.exit_code == 2 ? ExitCode::kBadInput : ExitCode::kFailed,
                  label.empty() ? words : fmt::format("{}: {}", label, words));
  }
  return Json::parse(value_or_fail(read_file(answer)));
}

/// How long a run steps, in units of its own: rods times simulated seconds, times what the step and the density do to
/// the cost of one. The level's factor was measured (scene/keys/accuracy_levels.h); rods collide as often as the free
/// area is small, which is within a tenth of rods of 2.5 and 4.5 mm at area fractions from 0.35 to 0.8.
double work_of(const scene::RunPlan& plan) {
  constexpr double kDensest = 0.95;
  const System& system = plan.system;
  const double area_fraction = std::min(kDensest, scene::total_area_fraction_of(system));
  return system.n_all_rods() * plan.longest_time() * scene::relative_cost(system.dt, system.impacts) /
         (1 - area_fraction);
}

/// What is measured, recorded and drawn goes with this.
double rod_seconds(const scene::RunPlan& plan) { return plan.system.n_all_rods() * plan.longest_time(); }

/// The costs of all points by that of one. Frames become more with the time of a run; checkpoints and observables, kept
/// at its end, hardly do.
std::vector<PointCost> scaled(const scene::Sweep& sweep, const Json& report, const scene::RunPlan& probed) {
  const double stepping = report.at("stepping_cpu_seconds").get<double>();
  const double besides = report.at("cpu_seconds").get<double>() - stepping;
  const double frames = report.at("disk_bytes").at("trajectory").get<double>();
  const double kept = report.at("disk_bytes").at("total").get<double>() - frames;
  std::vector<PointCost> runs;
  for (const scene::SweepPoint& point : sweep.points) {
    const double size = rod_seconds(point.plan) / rod_seconds(probed);
    const double rods = static_cast<double>(point.plan.system.n_all_rods()) / probed.system.n_all_rods();
    runs.push_back({stepping * work_of(point.plan) / work_of(probed), besides * size, frames * size + kept * rods,
                    rod_seconds(point.plan)});
  }
  return runs;
}

/// The costs of all runs as they are written, then of those of each step if there are several, else at each level of
/// accuracy: stepping changes by the ratio of the factors.
std::vector<LevelCost> levels_of(const scene::Sweep& sweep, const std::vector<PointCost>& runs) {
  struct Group {
    const System* own;
    std::size_t n_runs = 0;
    PointCost sum{};
  };
  std::vector<Group> groups;
  PointCost all;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const System& own = sweep.points[k].plan.system;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& one) {
      return one.own->dt == own.dt && one.own->impacts == own.impacts;
    });
    if (group == groups.end()) group = groups.insert(group, {&own});
    ++group->n_runs;
    group->sum += runs[k];
    all += runs[k];
  }
  std::vector<LevelCost> levels{{kAsWritten, std::nullopt, all.cpu(), all.disk, all.rod_seconds}};
  if (groups.size() == 1) {
    const System& own = *groups[0].own;
    levels[0].ticks = Ticks{own.dt, own.impacts};
    for (const scene::AccuracyLevel& level : scene::accuracy_levels()) {
      const double factor = level.cost / scene::relative_cost(own.dt, own.impacts);
      levels.push_back(
          {std::string(level.name), Ticks{level.step, level.impacts}, all.cpu(factor), all.disk, all.rod_seconds});
    }
    return levels;
  }
  for (const Group& group : groups) {
    const scene::AccuracyLevel* level = scene::accuracy_level(*group.own);
    levels.push_back(
        {fmt::format("{}{}", level != nullptr ? std::string(level->name) + ", " : "", counted(group.n_runs, "run")),
         Ticks{group.own->dt, group.own->impacts}, group.sum.cpu(), group.sum.disk, group.sum.rod_seconds});
  }
  return levels;
}

std::string ticks_text(const std::optional<Ticks>& ticks) {
  if (!ticks) return "several";
  const std::string step = keys::format_quantity(ticks->step, keys::Dimension::kTime);
  return ticks->impacts == System{}.impacts ? step : fmt::format("{}, {}", step, scene::name_of(ticks->impacts));
}

/// What a level is for, and what it does to the system that the levels were measured with; lines of at most `width`
/// columns.
std::string level_errors(const CostEstimate& estimate, std::size_t width) {
  std::string text;
  for (const LevelCost& level : estimate.levels) {
    const scene::AccuracyLevel* known = scene::accuracy_level(level.name);
    if (known == nullptr || known->bias.empty()) continue;
    const std::string indent(8, ' ');
    text += fmt::format("  {:<6}{}\n", level.name, known->what);
    std::string line = indent + fmt::format("averages within {:g} %", known->averages_within);
    std::string separator = ", ";
    for (const scene::Bias& bias : known->bias) {
      const std::string item =
          fmt::format("{} {:+.2g} +- {:.1g} {}", bias.observable, bias.value, bias.error, bias.unit);
      if (line.size() + separator.size() + item.size() + 1 > width && line.size() > indent.size()) {
        text += line + ",\n";
        line = indent;
        separator.clear();
      }
      line += separator + item;
      separator = ", ";
    }
    text += line + "\n";
  }
  if (text.empty()) return text;
  return "\nErrors of the levels, as measured with apolar rods of 4.5 mm at area fraction 0.75 in a box; this scene "
         "may\n"
         "have others (docs/accuracy.md):\n" +
         text;
}

}  // namespace

std::string cpu_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.2g} CPU-seconds", seconds);
  if (seconds < 3600) return fmt::format("{:.3g} CPU-minutes", seconds / 60);
  return fmt::format("{:.4g} CPU-hours", seconds / 3600);
}

CostEstimate estimate_cost(const scene::Sweep& sweep, const EstimateOptions& options) {
  CostEstimate estimate{.n_runs = sweep.points.size(), .shown = sweep.points.size() / 2};
  const scene::SweepPoint& point = sweep.points[estimate.shown];
  estimate.report = probe(point.plan, point.label, options.cpu, options.from);
  if (options.cpu == 0) return estimate;
  estimate.runs = scaled(sweep, estimate.report, point.plan);
  estimate.levels = levels_of(sweep, estimate.runs);
  return estimate;
}

std::string estimate_text(const CostEstimate& estimate, int width) {
  if (estimate.levels.empty()) return "";
  Table table({{"ACCURACY"},
               {"STEP", Table::Align::kRight},
               {"CPU TIME", Table::Align::kRight},
               {"ROD-S PER CPU-S", Table::Align::kRight},
               {"DISK", Table::Align::kRight}});
  for (const LevelCost& level : estimate.levels) {
    table.add_row({level.name, ticks_text(level.ticks), cpu_text(level.cpu), fmt::format("{:.3g}", level.speed()),
                   bytes_text(level.disk)});
  }
  std::string text = table.text(width);
  if (estimate.n_runs > 1) {
    text += fmt::format(
        "All {} runs together. One of them was probed; the others follow from their rods, times, steps and area\n"
        "fractions.\n",
        estimate.n_runs);
  }
  static constexpr std::size_t kWidth = 100;
  return text + level_errors(estimate, width > 0 ? static_cast<std::size_t>(width) : kWidth);
}

Json estimate_json(const CostEstimate& estimate) {
  Json json{{"n_runs", estimate.n_runs}, {"levels", Json::array()}};
  for (const LevelCost& level : estimate.levels) {
    Json entry{{"name", level.name},
               {"step_s", level.ticks ? Json(level.ticks->step) : Json()},
               {"impacts", level.ticks ? Json(scene::name_of(level.ticks->impacts)) : Json()},
               {"cpu_seconds", level.cpu},
               {"rod_seconds_per_cpu_second", level.speed()},
               {"disk_bytes", level.disk}};
    if (const scene::AccuracyLevel* known = scene::accuracy_level(level.name)) {
      entry["what"] = known->what;
      entry["averages_within_percent"] = known->averages_within;
      entry["just_hit_within_percent"] = known->just_hit_within;
      entry["bias"] = Json::array();
      for (const scene::Bias& bias : known->bias) {
        entry["bias"].push_back(
            {{"observable", bias.observable}, {"value", bias.value}, {"error", bias.error}, {"unit", bias.unit}});
      }
      entry["relative_cost"] = known->cost;
    }
    json["levels"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace shaken::client
