// SPDX-License-Identifier: MIT
#include "scene/measure_memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "scene/observables.h"

namespace shaken::scene {

namespace {

constexpr double kNumberBytes = 8;  ///< bytes of a double or a count
constexpr double kBlocks = 64;      ///< stretches of time that sums are kept for, at most (analysis/blocked.h)
constexpr double kSeries = 65536;   ///< points of a series against time, at most (analysis/bounded_series.h)
/// Arrays that grow with the run double when they are full too: between 1 and 2 times what is in them.
constexpr double kGrowing = 1.5;

/// What the formulas below are made of.
struct Sizes {
  const RunPlan& plan;
  double samples = 0;  ///< of this measurement in the whole run
  double rods = 0;     ///< that are measured

  double in_blocks(double bytes) const { return std::min(kBlocks, samples) * bytes; }
  double series(double columns) const { return std::min(kSeries, samples) * columns * kNumberBytes; }
  /// Kept for lags to come: of each of 16 levels the last 8 of every 2^k-th sample (analysis/lag_average.h), and sums
  /// over so many quantities at 69 lags.
  double for_lags(double columns, double quantities) const {
    double kept = 0;
    for (int k = 0; k < 16; ++k) kept += std::min(8.0, std::ceil(samples / std::exp2(k)));
    return kept * rods * columns * kNumberBytes + in_blocks(69 * (2 + quantities) * kNumberBytes);
  }
};

/// The nodes of a square grid of waves, of which one of each pair +-q is kept (analysis/wave_sums.h).
double half_plane(double waves) { return (waves + 1) * (2 * waves + 1); }

MeasureMemory of_defects(const Sizes& sizes) {
  const System& system = sizes.plan.system;
  const MeasureDefects& defects = *sizes.plan.defects;
  const double side = std::max(4.0, std::ceil(system.box_side / defects.grid_for(system.rod.length) - 1e-9));
  // Zeros of a Gaussian field that is smoothed over s: 1 / (4 pi s^2) of them an area (Halperin, Les Houches 35, 813
  // (1981)); the field has no more than one in a mesh.
  const double smoothing = defects.smoothing_for(system.rod.length);
  const double found =
      std::min(system.box_side * system.box_side / (4 * std::numbers::pi * smoothing * smoothing), side * side);
  constexpr double kTrack = 1200;  // with its last 17 places
  const double list = defects.list ? kGrowing * 6 * kNumberBytes * found * sizes.samples : 0;
  // Q, the density of rods and that of the nodes, each node's sum by rows and in all
  return {"", sizes.series(3) + found * kTrack + list, 5 * kNumberBytes * side * side};
}

MeasureMemory of_velocity(const Sizes& sizes) {
  const MeasureVelocity& velocity = *sizes.plan.velocity;
  const double window = std::max(1.0, std::round(velocity.window / velocity.every));
  return {"", sizes.for_lags(2, 4) + std::min(window, sizes.samples) * (sizes.rods * 2 * kNumberBytes + 100), 0};
}

MeasureMemory of_rods(const Sizes& sizes) {
  const MeasureRods& rods = *sizes.plan.rods;
  const double kept = std::min(sizes.samples, std::floor(rods.duration / rods.every * (1 + 1e-12)) + 1);
  return {"", kGrowing * kept * kNumberBytes * (4 * std::min<double>(rods.count, sizes.rods) + 1), 0};
}

MeasureMemory of_pairs(const Sizes& sizes) {
  const double bins = sizes.plan.pairs->bins;
  const double side = sizes.plan.system.box_side;
  const double range = std::min(sizes.plan.pairs->range_for(sizes.plan.system.rod.length, side), side / 2);
  const double cut = side / 2 / (2 * range / bins);
  return {"", sizes.in_blocks(2 * kNumberBytes * (bins * bins + 2 * cut)), 0};
}

MeasureMemory of_layers(const Sizes& sizes) {
  const double waves = std::min(40.0, std::floor(2 * sizes.plan.system.box_side / sizes.plan.system.rod.length));
  return {"", sizes.in_blocks(2 * kNumberBytes * (half_plane(waves) + 2 * waves)), half_plane(waves) * kNumberBytes};
}

/// How an observable's memory follows from the plan, and what makes it smaller.
struct Row {
  const char* name;
  MeasureMemory (*bytes)(const Sizes&);
  const char* remedy;
};

// clang-format off
constexpr std::array kRows{
    // its reduction looks for correlations, in copies of the series
    Row{"order", [](const Sizes& s) -> MeasureMemory { return {"", s.series(3) + s.in_blocks(1000), s.series(6)}; },
        "a longer `every`"},
    Row{"angles", [](const Sizes& s) -> MeasureMemory {
          return {"", s.in_blocks(kNumberBytes * s.plan.angles->bins + 100), 0}; }, "fewer `bins`"},
    Row{"tilt", [](const Sizes& s) -> MeasureMemory {
          return {"", s.in_blocks(3 * kNumberBytes * s.plan.tilt->bins + 200) + kNumberBytes * s.rods, 0}; }, "fewer `bins`"},
    Row{"defects", of_defects, "a coarser `grid`, or no `list`"},
    Row{"g2", [](const Sizes& s) -> MeasureMemory {
          return {"", s.in_blocks(3 * kNumberBytes * s.plan.g2->bins + 100), 0}; }, "fewer `bins`"},
    Row{"msd", [](const Sizes& s) -> MeasureMemory { return {"", s.for_lags(2, 6), 0}; }, "fewer rods"},
    Row{"rotation", [](const Sizes& s) -> MeasureMemory { return {"", s.for_lags(1, 4) + 2 * kNumberBytes * s.rods, 0}; },
        "fewer rods"},
    Row{"velocity", of_velocity, "a shorter `window`, or a longer `every`"},
    Row{"rods", of_rods, "a smaller `count`, a shorter `duration`, or a longer `every`"},
    // 1054 boxes of ten sizes
    Row{"fluctuations", [](const Sizes& s) -> MeasureMemory { return {"", s.in_blocks(1054 * 20), 0}; },
        "nothing but to leave it out"},
    // 84 waves in each sector that the director visits; a few of 36
    Row{"frank", [](const Sizes& s) -> MeasureMemory { return {"", s.in_blocks(3 * 90 * kNumberBytes), 0}; },
        "nothing but to leave it out"},
    Row{"pairs", of_pairs, "fewer `bins`"},
    Row{"layers", of_layers, "nothing but to leave it out"},
    Row{"lattice", [](const Sizes& s) -> MeasureMemory { return {"", s.in_blocks(200), half_plane(128) * kNumberBytes}; },
        "nothing but to leave it out"},
    Row{"structure", [](const Sizes& s) -> MeasureMemory {
          return {"", s.in_blocks(6 * kNumberBytes * s.plan.structure->waves + 100),
                  half_plane(s.plan.structure->waves) * kNumberBytes}; }, "fewer `waves`"},
};
// clang-format on

std::string bytes_shown(double bytes) {
  static constexpr std::array kUnits{"kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (bytes /= 1000; bytes >= 999.5 && unit + 1 < kUnits.size(); bytes /= 1000) ++unit;
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

}  // namespace

std::vector<MeasureMemory> measure_memory(const RunPlan& plan) {
  std::vector<MeasureMemory> memory;
  for (const Row& row : kRows) {
    const auto every = observable(row.name).period(plan);
    if (!every) continue;
    const double ticks = std::max(1.0, std::round(*every / plan.system.dt));
    const double samples = std::floor(plan.longest_time() / (ticks * plan.system.dt) * (1 + 1e-12)) + 1;
    memory.push_back(row.bytes({plan, samples, static_cast<double>(plan.system.n_rods)}));
    memory.back().name = row.name;
  }
  return memory;
}

double peak_of(const std::vector<MeasureMemory>& memory) {
  double states = 0, scratch = 0;
  for (const MeasureMemory& one : memory) {
    states += one.state;
    scratch = std::max(scratch, one.scratch);
  }
  return states + std::max(states, scratch);
}

std::vector<std::filesystem::path> cgroup_limits(const std::string& line) {
  const std::size_t first = line.find(':');
  const std::size_t second = line.find(':', first + 1);
  if (first == std::string::npos || second == std::string::npos) return {};
  const bool is_unified = second == first + 1;
  bool is_of_memory = is_unified;
  std::istringstream controllers(line.substr(first + 1, second - first - 1));
  for (std::string name; std::getline(controllers, name, ',');) is_of_memory = is_of_memory || name == "memory";
  if (!is_of_memory) return {};
  const std::filesystem::path top = is_unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
  const char* limit = is_unified ? "memory.max" : "memory.limit_in_bytes";
  std::vector<std::filesystem::path> files{top / limit};
  std::filesystem::path group = top;
  for (const auto& part : std::filesystem::path(line.substr(second + 1)).relative_path()) {
    group /= part;
    files.push_back(group / limit);
  }
  return files;
}

double memory_allowed() {
  double allowed = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    allowed = std::min(allowed, static_cast<double>(limit.rlim_cur));
  }
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    for (const std::filesystem::path& file : cgroup_limits(line)) {
      double bytes = 0;  // no number there ("max"), or no file: no limit
      if (std::ifstream(file) >> bytes && bytes > 0) allowed = std::min(allowed, bytes);
    }
  }
  return allowed;
}

std::optional<Problem> memory_problem(const RunPlan& plan, double allowed, const std::string& file,
                                      const std::string& label) {
  const std::vector<MeasureMemory> memory = measure_memory(plan);
  const double peak = peak_of(memory);
  if (peak <= allowed) return std::nullopt;
  const auto alone = [](const MeasureMemory& one) { return peak_of({one}); };
  const auto largest =
      std::max_element(memory.begin(), memory.end(), [&](const auto& a, const auto& b) { return alone(a) < alone(b); });
  const auto row = std::find_if(kRows.begin(), kRows.end(), [&](const Row& one) { return largest->name == one.name; });
  return Problem{file, 0, 0, "/measure/" + largest->name,
                 fmt::format("{}the measurements of this run would take about {} of memory, {} alone {}, and a process "
                             "may have {} here; smaller with {}",
                             label.empty() ? "" : label + ": ", bytes_shown(peak), largest->name,
                             bytes_shown(alone(*largest)), bytes_shown(allowed), row->remedy)};
}

}  // namespace shaken::scene
