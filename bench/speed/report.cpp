// SPDX-License-Identifier: MIT
#include "bench/speed/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/table.h"
#include "run/files/version.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string fixed(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }
std::string plain(double value) { return fmt::format("{:.10g}", value); }
std::string percent(double part, double whole) { return fixed(100 * part / whole, 1); }
std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::string heading(const Conditions& conditions) {
  std::string text = fmt::format("shaken {} on {}\n", run::version(), describe(conditions.machine));
  text += fmt::format(
      "state after {:.10g} simulated seconds{}; best of {} repetitions\n", conditions.warm_up,
      conditions.steady() ? "" : fmt::format(" (NOT the steady state: that takes {:.10g})", Conditions::kSteady),
      conditions.effort.repeat);
  return text;
}

Row scene_cells(const Case& scene) {
  return {plain(scene.length), plain(scene.area_fraction), plain(scene.side), std::to_string(scene.system().n_rods)};
}
const Row kSceneTitles{"l mm", "phi", "L mm", "N"};

Row joined(Row row, const Row& more) {
  row.insert(row.end(), more.begin(), more.end());
  return row;
}

Json head(const Conditions& conditions, const char* bench) {
  return {{"bench", bench},
          {"version", run::version()},
          {"machine", to_json(conditions.machine)},
          {"warm_up_s", conditions.warm_up},
          {"steady", conditions.steady()},
          {"repeat", conditions.effort.repeat}};
}

Json scene_json(const Case& scene) {
  return {{"length_mm", scene.length}, {"n_beads", scene.system().rod.n_beads}, {"area_fraction", scene.area_fraction},
          {"side_mm", scene.side},     {"n_rods", scene.system().n_rods},       {"dt_s", scene.dt}};
}

Json engine_json(const EngineSpeed& speed) {
  return {{"rod_s_per_cpu_s", speed.rate()},
          {"spread", speed.spread()},
          {"cpu_s", speed.cpu},
          {"ticks", speed.ticks},
          {"rod_seconds", speed.rod_seconds},
          {"plate_impulses", speed.plate_impulses},
          {"rod_impulses", speed.rod_impulses},
          {"impulses_per_cpu_s", static_cast<double>(speed.impulses()) / speed.best_cpu()},
          {"ns_per_impulse", 1e9 * speed.best_cpu() / static_cast<double>(speed.impulses())},
          {"bytes_per_rod", speed.bytes_per_rod}};
}

double impulses_cpu(const SceneSpeed& scene) {
  return impulses_alone(scene.bounds, scene.scheduled.plate_impulses, scene.scheduled.rod_impulses);
}
double memory_cpu(const SceneSpeed& scene) {
  return memory_alone(scene.bounds, scene.scheduled.plate_impulses, scene.scheduled.rod_impulses);
}

/// A field of a CSV file: quoted if need be (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

void flatten(const Json& value, const std::string& name, std::vector<std::pair<std::string, std::string>>& cells) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      flatten(member, name.empty() ? key : fmt::format("{}.{}", name, key), cells);
  } else if (value.is_array()) {
    std::string text;
    for (const Json& element : value) {
      if (!text.empty()) text += ' ';
      text += element.dump();
    }
    cells.emplace_back(name, text);
  } else {
    cells.emplace_back(name, value.is_string() ? csv_field(value.get<std::string>()) : value.dump());
  }
}

}  // namespace

std::string as_text(const Conditions& conditions, const std::vector<SceneSpeed>& scenes) {
  std::string text = heading(conditions);

  std::vector<Row> speed{joined(kSceneTitles, {"scheduled", "reference", "ratio", "spread", "spread", "impulses/CPU-s",
                                               "ns/impulse", "bytes/rod", "same state"})};
  for (const SceneSpeed& scene : scenes) {
    const EngineSpeed& fast = scene.scheduled;
    speed.push_back(joined(
        scene_cells(scene.scene),
        {fixed(fast.rate(), 1), fixed(scene.reference.rate(), 2), fixed(scene.ratio(), 1), fixed(fast.spread(), 3),
         fixed(scene.reference.spread(), 3), fmt::format("{:.3g}", fast.impulses() / fast.best_cpu()),
         fixed(1e9 * fast.best_cpu() / static_cast<double>(fast.impulses()), 0), fixed(fast.bytes_per_rod, 0),
         scene.hashes_equal() ? "yes" : "NO"}));
  }
  text +=
      "\nSimulated rod-seconds per CPU-second by either engine, in turn; spread is median over best CPU time of\n"
      "the scheduled and of the reference engine; same state: bitwise, after as many ticks by either.\n" +
      aligned(speed);

  std::vector<Row> phases{kSceneTitles};
  for (const char* name : kPhaseNames) phases[0].emplace_back(name);
  phases[0].emplace_back("other");
  for (const SceneSpeed& scene : scenes) {
    Row row = scene_cells(scene.scene);
    double booked = 0;
    for (const double seconds : scene.phases) {
      row.push_back(percent(seconds, scene.phases_cpu));
      booked += seconds;
    }
    row.push_back(percent(std::max(0.0, scene.phases_cpu - booked), scene.phases_cpu));  // < 0: the clock's error
    phases.push_back(row);
  }
  text += "\nWhere the scheduled engine's CPU time goes, in % (from a run of its own, without the clock's time).\n" +
          aligned(phases);

  std::vector<Row> bounds{
      joined(kSceneTitles, {"ns/plate impulse", "ns/rod-rod impulse", "ns/state", "impulses %", "memory %"})};
  for (const SceneSpeed& scene : scenes) {
    const double cpu = scene.scheduled.best_cpu();
    bounds.push_back(joined(scene_cells(scene.scene),
                            {fixed(1e9 * scene.bounds.plate_impulse, 0), fixed(1e9 * scene.bounds.rod_impulse, 0),
                             fixed(1e9 * scene.bounds.state_access, 1), percent(impulses_cpu(scene), cpu),
                             percent(memory_cpu(scene), cpu)}));
  }
  text +=
      "\nLower bounds: the share of the scheduled engine's time that its impulses alone take, if finding contacts\n"
      "were free, and the share that reading and writing the states of the rods hit takes, if computing were.\n" +
      aligned(bounds);
  return text;
}

Json as_json(const Conditions& conditions, const std::vector<SceneSpeed>& scenes) {
  Json report = head(conditions, "speed");
  report["rows"] = Json::array();
  for (const SceneSpeed& scene : scenes) {
    Json row = scene_json(scene.scene);
    row["scheduled"] = engine_json(scene.scheduled);
    row["reference"] = engine_json(scene.reference);
    row["ratio"] = scene.ratio();
    row["compared_ticks"] = scene.compared_ticks;
    row["scheduled"]["state_hash"] = hash_text(scene.scheduled_hash);
    row["reference"]["state_hash"] = hash_text(scene.reference_hash);
    row["hashes_equal"] = scene.hashes_equal();
    for (std::size_t p = 0; p < kPhases; ++p) row["phase_shares"][kPhaseNames[p]] = scene.phases[p] / scene.phases_cpu;
    row["lower_bounds"] = {{"plate_impulse_ns", 1e9 * scene.bounds.plate_impulse},
                           {"rod_impulse_ns", 1e9 * scene.bounds.rod_impulse},
                           {"state_access_ns", 1e9 * scene.bounds.state_access},
                           {"impulses_alone_share", impulses_cpu(scene) / scene.scheduled.best_cpu()},
                           {"memory_alone_share", memory_cpu(scene) / scene.scheduled.best_cpu()}};
    report["rows"].push_back(std::move(row));
  }
  return report;
}

std::string as_text(const Conditions& conditions, const Scaling& scaling) {
  const bool of_rods = scaling.of == Scaling::Of::kRods;
  std::vector<Row> rows{
      joined(kSceneTitles, {"dt us", "rod-s/CPU-s", "spread", "cost", "step cost", "bytes/rod", "max overlap %"})};
  for (std::size_t k = 0; k < scaling.points.size(); ++k) {
    const auto& [scene, speed] = scaling.points[k];
    rows.push_back(
        joined(scene_cells(scene),
               {plain(1e6 * scene.dt), fixed(speed.rate(), 1), fixed(speed.spread(), 3), fixed(scaling.relative(k), 3),
                k == 0 ? "" : fixed(scaling.points[k].cost() / scaling.points[k - 1].cost(), 3),
                fixed(speed.bytes_per_rod, 0), fixed(100 * speed.max_overlap / scene.system().rod.mid_diameter, 2)}));
  }
  return heading(conditions) +
         fmt::format(
             "\nCPU time per rod-second of the scheduled engine against {}: relative to the first row (cost) "
             "and to\nthe row before (step cost). Overlap: deepest since the start, in % of the rods' "
             "thickness.\n",
             of_rods ? "the number of rods" : "the step") +
         aligned(rows);
}

Json as_json(const Conditions& conditions, const Scaling& scaling) {
  Json report = head(conditions, scaling.of == Scaling::Of::kRods ? "scaling n" : "scaling dt");
  report["rows"] = Json::array();
  for (std::size_t k = 0; k < scaling.points.size(); ++k) {
    Json row = scene_json(scaling.points[k].scene);
    row["scheduled"] = engine_json(scaling.points[k].speed);
    row["relative_cost"] = scaling.relative(k);
    row["max_overlap_mm"] = scaling.points[k].speed.max_overlap;
    report["rows"].push_back(std::move(row));
  }
  return report;
}

std::string as_text(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes) {
  std::vector<Row> rows{
      joined(kSceneTitles, {"threads", "rod-s/wall-s", "speed-up", "CPU time", "spread", "same state"})};
  for (const ThreadsSpeed& scene : scenes) {
    for (std::size_t k = 0; k < scene.points.size(); ++k) {
      const auto& [threads, speed, hash] = scene.points[k];
      rows.push_back(
          joined(scene_cells(scene.scene),
                 {std::to_string(threads), fixed(speed.rod_seconds / speed.best_wall(), 1), fixed(scene.speed_up(k), 2),
                  fixed(speed.best_cpu() / scene.points.front().speed.best_cpu(), 2),
                  fixed(median(speed.wall) / speed.best_wall(), 3), hash == scene.points.front().hash ? "yes" : "NO"}));
    }
  }
  return heading(conditions) +
         "\nThe scheduled engine by several threads: wall time (so other programs on the machine count) and CPU time "
         "of\nall threads, both relative to the first row of the scene; spread: median over best wall time.\n" +
         aligned(rows);
}

Json as_json(const Conditions& conditions, const std::vector<ThreadsSpeed>& scenes) {
  Json report = head(conditions, "threads");
  report["rows"] = Json::array();
  for (const ThreadsSpeed& scene : scenes) {
    for (std::size_t k = 0; k < scene.points.size(); ++k) {
      const auto& [threads, speed, hash] = scene.points[k];
      Json row = scene_json(scene.scene);
      row["threads"] = threads;
      row["wall_s"] = speed.wall;
      row["cpu_s"] = speed.cpu;
      row["rod_s_per_wall_s"] = speed.rod_seconds / speed.best_wall();
      row["speed_up"] = scene.speed_up(k);
      row["state_hash"] = hash_text(hash);
      row["hashes_equal"] = hash == scene.points.front().hash;
      report["rows"].push_back(std::move(row));
    }
  }
  return report;
}

std::string as_csv(const Json& rows) {
  std::string text;
  for (const Json& row : rows) {
    std::vector<std::pair<std::string, std::string>> cells;
    flatten(row, "", cells);
    std::string titles;
    std::string line;
    for (const auto& [name, value] : cells) {
      titles += (titles.empty() ? "" : ",") + name;
      line += (line.empty() ? "" : ",") + value;
    }
    if (text.empty()) text = titles + "\n";
    text += line + "\n";
  }
  return text;
}

}  // namespace shaken::bench
