// SPDX-License-Identifier: MIT
#include "client/cost_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/failure.h"
#include "base/files.h"
#include "base/keys/units.h"
#include "base/process.h"
#include "base/progress_line.h"
#include "base/scratch_folder.h"
#include "base/table.h"
#include "base/text.h"
#include "scene/accuracy_levels.h"
#include "scene/canonical.h"
#include "scene/derived.h"
#include "scene/load.h"
#include "scene/observables.h"

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

/// Costs of a run in the units that change least from run to run.
struct Rates {
  double stepping = 0;  ///< CPU time per rod and simulated second
  double besides = 0;   ///< the same of measuring, recording, drawing
  double disk = 0;      ///< bytes per rod and simulated second
  double most = 0;      ///< the same of what the disk must have room for
  double memory = 0;    ///< bytes per rod
};

double rod_seconds(const scene::RunPlan& plan) { return plan.system.n_all_rods() * plan.total_time(); }

Rates rates_of(const Json& report, const scene::RunPlan& plan) {
  const double stepping = report.at("stepping_cpu_seconds").get<double>();
  const double all = rod_seconds(plan);
  return {stepping / all, (report.at("cpu_seconds").get<double>() - stepping) / all,
          report.at("disk_bytes").at("total").get<double>() / all,
          report.at("disk_bytes").at("most").get<double>() / all,
          report.at("memory_bytes").get<double>() / plan.system.n_all_rods()};
}

/// At most `most` of `n` places, from the first to the last; if only one is wanted, the middle. They are rounded, not
/// cut off, so that they do not keep step with the inner axis of a grid.
std::vector<std::size_t> evenly(std::size_t n, std::size_t most) {
  const std::size_t steps = std::min(n, most) - 1;
  if (steps == 0) return {n / 2};
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k <= steps; ++k) places.push_back((k * (n - 1) + steps / 2) / steps);
  return places;
}

class Estimator {
 public:
  Estimator(const scene::Sweep& sweep, const EstimateOptions& options) : sweep_(sweep), options_(options) {}

  CostEstimate run() {
    find_distinct();
    const std::vector<std::size_t> probed = evenly(distinct_.size(), options_.most_probes);
    const std::size_t shown = probed[probed.size() / 2];

    result_.n_runs = sweep_.points.size();
    result_.n_distinct = distinct_.size();
    result_.shown = distinct_[shown];
    if (!options_.probe) {
      result_.report = probe(plan_of(shown), label_of(shown), 0, "");
      return std::move(result_);
    }
    result_.n_probed = probed.size();
    n_probes_ = probed.size();
    if (options_.on_probe) options_.on_probe(0, n_probes_);
    result_.report = probe_plan(plan_of(shown), label_of(shown), options_.from);
    std::vector<Rates> rates;
    rates.reserve(probed.size());
    for (const std::size_t k : probed) {
      rates.push_back(rates_of(k == shown ? result_.report : probe_plan(plan_of(k), label_of(k), ""), plan_of(k)));
    }
    rates = interpolated(probed, rates);
    result_.runs = runs_at(rates);
    const Costs costs = add_up(rates);
    const System& own = plan_of(shown).system;
    const std::optional<Ticks> ticks = are_alike_in_time() ? std::optional(Ticks{own.dt, own.impacts}) : std::nullopt;
    result_.levels.push_back({kAsWritten, ticks, costs.cpu(1), costs.disk});
    if (ticks) {
      add_levels(own, costs);
    } else {
      add_costs_of_steps(rates);
    }
    if (options_.on_probe) options_.on_probe(n_probes_, n_probes_);
    return std::move(result_);
  }

 private:
  /// Of all runs together.
  struct Costs {
    double stepping = 0, besides = 0, disk = 0;
    /// With a step that makes stepping so many times as long.
    double cpu(double factor) const { return factor * stepping + besides; }
  };

  const scene::RunPlan& plan_of(std::size_t k) const { return sweep_.points[distinct_[k]].plan; }
  const std::string& label_of(std::size_t k) const { return sweep_.points[distinct_[k]].label; }
  /// All points have one step, and treat impacts in one way.
  bool are_alike_in_time() const {
    const System& first = sweep_.points.front().plan.system;
    return std::all_of(sweep_.points.begin(), sweep_.points.end(), [&](const scene::SweepPoint& point) {
      return point.plan.system.dt == first.dt && point.plan.system.impacts == first.impacts;
    });
  }
  Json probe_plan(const scene::RunPlan& plan, const std::string& label, const std::string& from) {
    Json report = probe(plan, label, options_.cpu / static_cast<double>(n_probes_), from);
    ++n_done_;
    if (options_.on_probe) options_.on_probe(std::min(n_done_, n_probes_ - 1), n_probes_);
    return report;
  }

  void find_distinct() {
    std::map<std::string, std::size_t> seen;
    for (std::size_t p = 0; p < sweep_.points.size(); ++p) {
      scene::RunPlan plan = sweep_.points[p].plan;
      plan.system.seed = 0;
      const auto [at, is_new] = seen.emplace(scene::scene_hash(plan), distinct_.size());
      if (is_new) {
        distinct_.push_back(p);
        n_alike_.push_back(0);
      }
      ++n_alike_[at->second];
      kind_.push_back(at->second);
    }
  }

  /// Of each kind of run. Between two probed points the rates go straight from those of the one to those of the other.
  std::vector<Rates> interpolated(const std::vector<std::size_t>& probed, const std::vector<Rates>& rates) const {
    std::vector<Rates> all;
    all.reserve(distinct_.size());
    std::size_t next = 0;  // the first probed point that is not before k
    for (std::size_t k = 0; k < distinct_.size(); ++k) {
      while (next + 1 < probed.size() && probed[next] < k) ++next;
      const std::size_t before = next > 0 ? next - 1 : 0;
      const double width = static_cast<double>(probed[next] - probed[before]);
      const double part = width > 0 ? static_cast<double>(k - probed[before]) / width : 1;
      const auto between = [&](double Rates::*rate) { return std::lerp(rates[before].*rate, rates[next].*rate, part); };
      all.push_back({between(&Rates::stepping), between(&Rates::besides), between(&Rates::disk), between(&Rates::most),
                     between(&Rates::memory)});
    }
    return all;
  }

  Costs add_up(const std::vector<Rates>& rates) const {
    Costs sum;
    for (std::size_t k = 0; k < distinct_.size(); ++k) {
      const double size = static_cast<double>(n_alike_[k]) * rod_seconds(plan_of(k));
      sum.stepping += size * rates[k].stepping;
      sum.besides += size * rates[k].besides;
      sum.disk += size * rates[k].disk;
    }
    return sum;
  }

  std::vector<RunCost> runs_at(const std::vector<Rates>& rates) const {
    std::vector<RunCost> runs;
    runs.reserve(kind_.size());
    for (const std::size_t k : kind_) {
      const scene::RunPlan& plan = plan_of(k);
      const double size = rod_seconds(plan);
      runs.push_back(
          {.cpu = size * (rates[k].stepping + rates[k].besides),
           .disk = size * rates[k].disk,
           .most = size * rates[k].most,
           .memory = plan.system.n_all_rods() * rates[k].memory + scene::peak_of(scene::measure_memory(plan))});
    }
    return runs;
  }

  /// Where the points have several steps: what the runs of each of them cost.
  void add_costs_of_steps(const std::vector<Rates>& rates) {
    struct Part {
      std::size_t shown, n_runs;
      double cpu, disk;
    };
    std::vector<Part> parts;
    for (std::size_t k = 0; k < distinct_.size(); ++k) {
      const auto same = std::find_if(parts.begin(), parts.end(), [&](const Part& part) {
        const System &one = plan_of(part.shown).system, &other = plan_of(k).system;
        return one.dt == other.dt && one.impacts == other.impacts;
      });
      Part& part = same != parts.end() ? *same : parts.emplace_back(Part{k, 0, 0, 0});
      const double size = static_cast<double>(n_alike_[k]) * rod_seconds(plan_of(k));
      part.n_runs += n_alike_[k];
      part.cpu += size * (rates[k].stepping + rates[k].besides);
      part.disk += size * rates[k].disk;
    }
    for (const Part& part : parts) {
      const System& own = plan_of(part.shown).system;
      const scene::AccuracyLevel* level = scene::accuracy_level(own);
      result_.levels.push_back(
          {fmt::format("{}{}", level != nullptr ? std::string(level->name) + ", " : "", counted(part.n_runs, "run")),
           Ticks{own.dt, own.impacts}, part.cpu, part.disk});
    }
  }

  /// By the costs that were measured at the levels (scene/accuracy_levels.h): stepping changes by their ratio.
  void add_levels(const System& own, const Costs& costs) {
    for (const scene::AccuracyLevel& level : scene::accuracy_levels()) {
      const double factor = level.cost / scene::relative_cost(own.dt, own.impacts);
      result_.levels.push_back(
          {std::string(level.name), Ticks{level.step, level.impacts}, costs.cpu(factor), costs.disk});
    }
  }

  const scene::Sweep& sweep_;
  const EstimateOptions& options_;
  CostEstimate result_;
  std::vector<std::size_t> distinct_;      ///< the first point of each kind
  std::vector<std::size_t> n_alike_;       ///< (distinct_) how many points are of the kind
  std::vector<std::size_t> kind_;          ///< (points) the place of its kind in distinct_
  std::size_t n_probes_ = 0, n_done_ = 0;  ///< to be made, and made
};

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

ProbeProgress probe_progress(const Console& console, bool in_logs) {
  if (!console.err_is_terminal && !in_logs) return {};
  constexpr double kLogPeriod = 10;
  const auto line = std::make_shared<ProgressLine>(console.err, console.err_is_terminal, console.width, kLogPeriod);
  return [line](std::size_t done, std::size_t all) {
    if (done < all) {
      line->show(fmt::format("probing what it costs: {} of {}", done + 1, all));
    } else {
      line->clear();
    }
  };
}

CostEstimate estimate_cost(const scene::Sweep& sweep, const EstimateOptions& options) {
  return Estimator(sweep, options).run();
}

std::string estimate_text(const CostEstimate& estimate, int width) {
  if (estimate.levels.empty()) return "";
  Table table({{"ACCURACY"},
               {"STEP", Table::Align::kRight},
               {"CPU TIME", Table::Align::kRight},
               {"DISK", Table::Align::kRight}});
  for (const LevelCost& level : estimate.levels) {
    table.add_row({level.name, ticks_text(level.ticks), cpu_text(level.cpu), bytes_text(level.disk)});
  }
  std::string text = table.text(width);
  if (estimate.n_runs > 1) {
    text += fmt::format("All {} runs together. ", estimate.n_runs);
    if (estimate.n_distinct < estimate.n_runs)
      text += fmt::format("{} differ in more than their seed. ", estimate.n_distinct);
    text += estimate.n_probed < estimate.n_distinct
                ? fmt::format("{} of them were probed; the others are interpolated between these.\n", estimate.n_probed)
                : "Each of these was probed.\n";
    text += estimate.levels.size() > 1 ? "The steps of the levels were probed at one point, and change the cost of the "
                                         "others by the same factor.\n"
                                       : "";
  }
  static constexpr std::size_t kWidth = 100;
  return text + level_errors(estimate, width > 0 ? static_cast<std::size_t>(width) : kWidth);
}

Json estimate_json(const CostEstimate& estimate) {
  Json json{{"n_runs", estimate.n_runs}, {"n_distinct", estimate.n_distinct}, {"n_probed", estimate.n_probed}};
  json["levels"] = Json::array();
  for (const LevelCost& level : estimate.levels) {
    Json entry{{"name", level.name},
               {"step_s", level.ticks ? Json(level.ticks->step) : Json()},
               {"impacts", level.ticks ? Json(scene::name_of(level.ticks->impacts)) : Json()},
               {"cpu_seconds", level.cpu},
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
