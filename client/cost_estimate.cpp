// SPDX-License-Identifier: MIT
#include "client/cost_estimate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>

#include "base/failure.h"
#include "base/files.h"
#include "base/process.h"
#include "base/table.h"
#include "scene/accuracy.h"
#include "scene/canonical.h"
#include "scene/derived.h"
#include "scene/load.h"
#include "scene/units.h"

namespace shaken::client {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAsWritten = "as written";

/// A file that goes with the object.
class ScratchFile {
 public:
  explicit ScratchFile(const char* ending) {
    std::string name = (fs::temp_directory_path() / "shaken-XXXXXX").string() + ending;
    const int fd = mkstemps(name.data(), static_cast<int>(std::string_view(ending).size()));
    if (fd < 0) throw Failure(ExitCode::kFailed, name + " cannot be made");
    close(fd);
    path_ = name;
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

/// What shaken-worker says of one run.
Json probe(const scene::RunPlan& plan, const std::string& label, double cpu, const std::string& from) {
  const ScratchFile scene(".json");
  const ScratchFile answer(".json");
  if (const auto error = write_file(scene.path(), scene::to_json(plan).dump())) {
    throw Failure(ExitCode::kFailed, error->message);
  }
  std::vector<std::string> command{sibling_program("shaken-worker").string(),
                                   scene.path(),
                                   "--probe",
                                   answer.path(),
                                   "--probe-cpu",
                                   fmt::format("{}", cpu)};
  if (!from.empty()) command.insert(command.end(), {"--probe-from", from});
  const Captured result = run_captured(command);
  if (result.exit_code != 0) {
    std::string words = result.output;
    words.erase(words.find_last_not_of('\n') + 1);
    throw Failure(result.exit_code == 2 ? ExitCode::kBadInput : ExitCode::kFailed,
                  label.empty() ? words : fmt::format("{}: {}", label, words));
  }
  const auto text = read_file(answer.path());
  if (!text) throw Failure(ExitCode::kFailed, text.error().message);
  return Json::parse(*text);
}

/// Costs of a run in the units that change least from run to run.
struct Rates {
  double stepping = 0;  ///< CPU time per rod and simulated second
  double besides = 0;   ///< the same of measuring, recording, drawing
  double disk = 0;      ///< bytes per rod and simulated second
};

double rod_seconds(const scene::RunPlan& plan) { return plan.system.n_all_rods() * plan.total_time(); }

Rates rates_of(const Json& report, const scene::RunPlan& plan) {
  const double stepping = report.at("stepping_cpu_seconds").get<double>();
  const double all = rod_seconds(plan);
  return {stepping / all, (report.at("cpu_seconds").get<double>() - stepping) / all,
          report.at("disk_bytes").at("total").get<double>() / all};
}

/// What the cost of a run depends on, apart from the step.
using Features = std::array<double, 9>;

Features features_of(const scene::RunPlan& plan) {
  const Scene& s = plan.system;
  return {std::log(s.n_rods),
          scene::area_fraction_of(s),
          std::log(s.rod.length),
          s.rod.end_diameter / s.rod.mid_diameter,
          std::log(s.gap),
          s.amplitude * s.frequency,
          s.rod_base.restitution + s.rod_lid.restitution,
          s.rod_rod.restitution,
          s.rod_rod.friction + s.rod_base.friction + s.rod_lid.friction};
}

/// Each feature over [0, 1].
void normalise(std::vector<Features>& features) {
  for (std::size_t f = 0; f < Features{}.size(); ++f) {
    const auto less = [f](const Features& a, const Features& b) { return a[f] < b[f]; };
    const auto [low, high] = std::minmax_element(features.begin(), features.end(), less);
    const double from = (*low)[f];
    const double width = (*high)[f] - from;
    for (Features& row : features) row[f] = width > 0 ? (row[f] - from) / width : 0.0;
  }
}

double distance2(const Features& a, const Features& b) {
  return std::transform_reduce(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                               [](double x, double y) { return (x - y) * (x - y); });
}

/// The one nearest to the middle of all, then each time the one furthest from those chosen.
std::vector<std::size_t> spread_out(const std::vector<Features>& features, std::size_t n) {
  Features middle;
  middle.fill(0.5);
  const auto nearer = [&](const Features& a, const Features& b) { return distance2(a, middle) < distance2(b, middle); };
  std::vector<std::size_t> chosen{
      static_cast<std::size_t>(std::min_element(features.begin(), features.end(), nearer) - features.begin())};
  std::vector<double> away(features.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < n) {
    for (std::size_t i = 0; i < features.size(); ++i) {
      away[i] = std::min(away[i], distance2(features[i], features[chosen.back()]));
    }
    chosen.push_back(static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin()));
  }
  return chosen;
}

/// Cost per simulated second against the step: straight between the probed steps, both logarithmic, and beyond them.
class StepCurve {
 public:
  void add(double step, double cost) { points_[std::log(step)] = std::log(cost); }
  double at(double step) const {
    const double x = std::log(step);
    if (points_.size() == 1) return std::exp(points_.begin()->second);
    auto after = points_.lower_bound(x);
    if (after == points_.begin()) ++after;
    if (after == points_.end()) --after;
    const auto before = std::prev(after);
    const double slope = (after->second - before->second) / (after->first - before->first);
    return std::exp(before->second + slope * (x - before->first));
  }

 private:
  std::map<double, double> points_;
};

/// The plan at another step, or what speaks against it.
std::optional<scene::RunPlan> at_step(const scene::RunPlan& plan, double step, std::string& error) {
  nlohmann::ordered_json scene = scene::to_json(plan);
  scene["time"]["step"] = step;
  auto loaded = scene::load_scene(scene.dump(), "scene");
  if (!loaded.value) error = loaded.problems.front().message;
  return loaded.value;
}

class Estimator {
 public:
  Estimator(const scene::Sweep& sweep, const EstimateOptions& options) : sweep_(sweep), options_(options) {}

  CostEstimate run() {
    find_distinct();
    std::vector<Features> features;
    for (const std::size_t point : distinct_) features.push_back(features_of(plan_of(point)));
    normalise(features);
    const auto probed = spread_out(features, std::min(distinct_.size(), options_.most_probes));
    const std::size_t central = distinct_[probed.front()];

    result_.n_runs = sweep_.points.size();
    result_.n_distinct = distinct_.size();
    result_.shown = central;
    if (!options_.probe) {
      result_.report = probe(plan_of(central), sweep_.points[central].label, 0, "");
      return std::move(result_);
    }
    result_.n_probed = probed.size();
    n_probes_ = probed.size() + (options_.from.empty() ? 0 : 1);
    for (const scene::AccuracyLevel& level : scene::accuracy_levels()) {
      n_probes_ += options_.levels && level.step != plan_of(central).system.dt;
    }
    if (options_.on_probe) options_.on_probe(0, n_probes_);
    result_.report = probe_point(central, options_.from);
    probe_steps(central);

    // at the step of the central point, so that they can be compared
    const double step = plan_of(central).system.dt;
    std::vector<Rates> rates;
    for (const std::size_t k : probed) {
      const std::size_t point = distinct_[k];
      Rates rate = rates_of(point == central ? result_.report : probe_point(point, ""), plan_of(point));
      rate.stepping *= steps_.at(step) / steps_.at(plan_of(point).system.dt);
      rates.push_back(rate);
    }
    std::vector<Rates> of_distinct;
    for (std::size_t i = 0; i < distinct_.size(); ++i) of_distinct.push_back(interpolated(i, features, probed, rates));
    add_up(of_distinct, step);
    if (options_.on_probe) options_.on_probe(n_probes_, n_probes_);
    return std::move(result_);
  }

 private:
  const scene::RunPlan& plan_of(std::size_t point) const { return sweep_.points[point].plan; }
  Json probe_point(std::size_t point, const std::string& from) {
    return probe_plan(plan_of(point), sweep_.points[point].label, from);
  }
  Json probe_plan(const scene::RunPlan& plan, const std::string& label, const std::string& from) {
    Json report = probe(plan, label, options_.cpu, from);
    ++n_probed_;
    if (options_.on_probe) options_.on_probe(std::min(n_probed_, n_probes_ - 1), n_probes_);
    return report;
  }

  void find_distinct() {
    std::map<std::string, std::size_t> seen;
    for (std::size_t p = 0; p < sweep_.points.size(); ++p) {
      scene::RunPlan plan = plan_of(p);
      plan.system.seed = 0;
      const auto [at, is_new] = seen.emplace(scene::run_id(plan), distinct_.size());
      if (is_new) {
        distinct_.push_back(p);
        n_alike_.push_back(0);
      }
      ++n_alike_[at->second];
    }
  }

  void probe_steps(std::size_t central) {
    const scene::RunPlan& own = plan_of(central);
    // A saved state fits one step only. So that steps can be compared, all of them begin where the run begins.
    const Json from_start = options_.from.empty() ? result_.report : probe_point(central, "");
    steps_.add(own.system.dt, rates_of(from_start, own).stepping);
    if (!options_.levels) return;
    for (const scene::AccuracyLevel& level : scene::accuracy_levels()) {
      LevelCost cost{std::string(level.name), level.step, "", {}, {}};
      if (level.step != own.system.dt) {
        if (const auto plan = at_step(own, level.step, cost.error)) {
          try {
            const std::string label = fmt::format("accuracy={}", level.name);
            steps_.add(level.step, rates_of(probe_plan(*plan, label, ""), *plan).stepping);
          } catch (const Failure& failure) {
            cost.error = failure.what();
          }
        }
      }
      result_.levels.push_back(std::move(cost));
    }
  }

  /// Means of logarithms, weighted with the inverse square of the distance (Shepard 1968).
  static Rates interpolated(std::size_t i, const std::vector<Features>& features,
                            const std::vector<std::size_t>& probed, const std::vector<Rates>& rates) {
    double weights = 0;
    double stepping = 0;
    Rates mean;
    for (std::size_t k = 0; k < probed.size(); ++k) {
      if (probed[k] == i) return rates[k];
      const double weight = 1 / std::max(1e-12, distance2(features[i], features[probed[k]]));
      weights += weight;
      stepping += weight * std::log(rates[k].stepping);
      mean.besides += weight * rates[k].besides;
      mean.disk += weight * rates[k].disk;
    }
    return {std::exp(stepping / weights), mean.besides / weights, mean.disk / weights};
  }

  void add_up(const std::vector<Rates>& rates, double step) {
    LevelCost written{kAsWritten, plan_of(distinct_.front()).system.dt, "", 0.0, 0.0};
    for (LevelCost& level : result_.levels) {
      if (level.error.empty()) level.cpu = level.disk = 0;
    }
    for (std::size_t i = 0; i < distinct_.size(); ++i) {
      const scene::RunPlan& plan = plan_of(distinct_[i]);
      const double all = static_cast<double>(n_alike_[i]) * rod_seconds(plan);
      const auto add = [&](LevelCost& level, double dt) {
        if (!level.cpu) return;
        *level.cpu += all * (rates[i].stepping * steps_.at(dt) / steps_.at(step) + rates[i].besides);
        *level.disk += all * rates[i].disk;
      };
      add(written, plan.system.dt);
      for (LevelCost& level : result_.levels) add(level, level.step);
      if (plan.system.dt != written.step) written.step = 0;
    }
    result_.levels.insert(result_.levels.begin(), std::move(written));
  }

  const scene::Sweep& sweep_;
  const EstimateOptions& options_;
  CostEstimate result_;
  std::vector<std::size_t> distinct_;  ///< the first point of each kind
  std::vector<std::size_t> n_alike_;   ///< (distinct_) how many points are of the kind
  StepCurve steps_;
  std::size_t n_probes_ = 0, n_probed_ = 0;  ///< to be made, and made
};

std::string step_text(double step) {
  return step > 0 ? scene::format_quantity(step, scene::Dimension::kTime) : "several";
}

/// What the step of a level does to the system that the levels were measured with; lines of at most `width` columns.
std::string level_errors(const CostEstimate& estimate, std::size_t width) {
  std::string text;
  for (const LevelCost& level : estimate.levels) {
    const scene::AccuracyLevel* known = scene::accuracy_level(level.name);
    if (known == nullptr || known->bias.empty()) continue;
    const std::string indent(8, ' ');
    std::string line = fmt::format("  {:<6}", level.name);
    std::string separator;
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

std::string bytes_text(double bytes) {
  constexpr std::array<const char*, 5> kUnits{"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < kUnits.size()) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

std::string cpu_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.2g} CPU-seconds", seconds);
  if (seconds < 3600) return fmt::format("{:.3g} CPU-minutes", seconds / 60);
  return fmt::format("{:.4g} CPU-hours", seconds / 3600);
}

ProbeProgress probe_progress(const Console& console) {
  if (!console.err_is_terminal) return {};
  return [&err = console.err](std::size_t done, std::size_t all) {
    err << "\r\x1b[K";
    if (done < all) err << fmt::format("probing what it costs: {} of {}", done + 1, all);
    err << std::flush;
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
               {"DISK", Table::Align::kRight},
               {""}});
  for (const LevelCost& level : estimate.levels) {
    table.add_row({level.name, step_text(level.step), level.cpu ? cpu_text(*level.cpu) : "-",
                   level.disk ? bytes_text(*level.disk) : "-",
                   level.error.empty() ? "" : "not possible: " + level.error});
  }
  std::string text = table.text(width);
  if (estimate.n_runs > 1) {
    text += fmt::format("All {} runs together. ", estimate.n_runs);
    if (estimate.n_distinct < estimate.n_runs)
      text += fmt::format("{} differ in more than their seed. ", estimate.n_distinct);
    text += estimate.n_probed < estimate.n_distinct
                ? fmt::format("{} of them were probed; the others are interpolated from these.\n", estimate.n_probed)
                : "Each of these was probed.\n";
    text += "The steps of the levels were probed at one point, and change the cost of the others by the same factor.\n";
  }
  static constexpr std::size_t kWidth = 100;
  return text + level_errors(estimate, width > 0 ? static_cast<std::size_t>(width) : kWidth);
}

Json estimate_json(const CostEstimate& estimate) {
  Json json{{"n_runs", estimate.n_runs}, {"n_distinct", estimate.n_distinct}, {"n_probed", estimate.n_probed}};
  json["levels"] = Json::array();
  for (const LevelCost& level : estimate.levels) {
    Json entry{{"name", level.name},
               {"step_s", level.step > 0 ? Json(level.step) : Json()},
               {"cpu_seconds", level.cpu ? Json(*level.cpu) : Json()},
               {"disk_bytes", level.disk ? Json(*level.disk) : Json()}};
    if (!level.error.empty()) entry["error"] = level.error;
    if (const scene::AccuracyLevel* known = scene::accuracy_level(level.name)) {
      entry["bias"] = Json::array();
      for (const scene::Bias& bias : known->bias) {
        entry["bias"].push_back(
            {{"observable", bias.observable}, {"value", bias.value}, {"error", bias.error}, {"unit", bias.unit}});
      }
      if (known->cost) entry["relative_cost"] = *known->cost;
    }
    json["levels"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace shaken::client
