// SPDX-License-Identifier: MIT
#include "client/paper/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "client/paper/figures.h"

namespace shaken::client {
namespace {

double sum_of(const RunSet& runs, const char* scalar) {
  double sum = 0;
  for (const FinishedRun& run : runs) sum += run.scalar(scalar).value;
  return sum;
}

std::string range_text(const RunSet& runs, const char* scalar) {
  double low = INFINITY, high = 0;
  for (const FinishedRun& run : runs) {
    const double value = run.scalar(scalar).value;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low == high ? fmt::format("{:g}", low) : fmt::format("{:g} to {:g}", low, high);
}

}  // namespace

std::string sweep_cost_table(const Library& runs, std::span<const std::string_view> sweeps) {
  std::string table = "| sweep | runs | rods | simulated s | CPU-hours |\n|---|---|---|---|---|\n";
  double all = 0;
  std::size_t n_all = 0;
  for (const std::string_view name : sweeps) {
    const RunSet& set = runs[std::string(name)];
    if (set.empty()) continue;
    const double cpu = sum_of(set, "cpu_seconds") / 3600;
    all += cpu;
    n_all += set.size();
    table += fmt::format("| {} | {} | {} | {} | {:.2f} |\n", name, set.size(), range_text(set, "n_rods"),
                         range_text(set, "sim_seconds"), cpu);
  }
  return table + fmt::format("| all | {} | | | {:.2f} |\n", n_all, all);
}

std::string origin_text(const Library& runs, std::span<const std::string_view> sweeps) {
  struct Made {
    int n = 0;
    std::string last;
  };
  std::map<std::string, Made> by_version;
  for (const std::string_view name : sweeps) {
    for (const FinishedRun& run : runs[std::string(name)]) {
      Made& made = by_version[run.versions()];
      ++made.n;
      made.last = std::max(made.last, run.finished());
    }
  }
  if (by_version.empty()) return "No run is there.\n";
  std::string list;
  for (const auto& [version, made] : by_version) {
    list += fmt::format("- {} runs by {}, the last of them finished at {}\n", made.n, version, made.last);
  }
  return list;
}

std::string figure_cost_table(const Library& runs) {
  std::string table = "| figure | shows | sweeps | CPU-hours |\n|---|---|---|---|\n";
  for (const PaperFigure& figure : paper_figures()) {
    std::string sweeps;
    double cpu = 0;
    bool known = true;  // a sweep without runs has no cost yet, not none
    for (const std::string_view set : figure.sets) {
      sweeps += (sweeps.empty() ? "" : ", ") + std::string(set);
      cpu += sum_of(runs[std::string(set)], "cpu_seconds") / 3600;
      known &= !runs[std::string(set)].empty();
    }
    table += fmt::format("| {} | {} | {} | {} |\n", figure.id, figure.title, sweeps,
                         known ? fmt::format("{:.2f}", cpu) : "not run");
  }
  return table;
}

}  // namespace shaken::client
