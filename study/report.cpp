// SPDX-License-Identifier: MIT
#include "study/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/failure.h"
#include "base/files.h"
#include "study/figures.h"
#include "study/selection.h"

namespace shaken::study {
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

std::set<std::string> versions_of(const Library& runs, std::span<const std::string_view> sweeps) {
  std::set<std::string> versions;
  for (const std::string_view name : sweeps) {
    for (const FinishedRun& run : runs[std::string(name)]) versions.insert(run.versions());
  }
  return versions;
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
    table += fmt::format("| {} | {} | {} | {} |\n", figure.id(), figure.title, sweeps,
                         known ? fmt::format("{:.2f}", cpu) : "not run");
  }
  return table;
}

std::string with_section(const std::string& document, const std::string& name, const std::string& table) {
  const std::string begin_mark = fmt::format("<!-- {}: begin -->\n", name);
  const std::string end_mark = fmt::format("<!-- {}: end -->", name);
  const std::size_t begin = document.find(begin_mark);
  const std::size_t end = document.find(end_mark);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw Failure(ExitCode::kBadInput, fmt::format("the report lacks the lines {}{}", begin_mark, end_mark));
  }
  return document.substr(0, begin + begin_mark.size()) + table + document.substr(end);
}

std::string with_sections(const std::filesystem::path& file,
                          const std::vector<std::pair<std::string, std::string>>& sections) {
  std::string document = value_or_fail(read_file(file), ExitCode::kBadInput), problems;
  for (const auto& [name, table] : sections) {
    try {
      document = with_section(document, name, table);
    } catch (const Failure& failure) {
      problems += (problems.empty() ? "" : "\n") + std::string(failure.what());
    }
  }
  if (!problems.empty()) throw Failure(ExitCode::kBadInput, problems);
  return document;
}

std::vector<std::pair<std::string, std::string>> report_sections(const Library& runs) {
  return {{"origin", origin_text(runs, all_sets())},
          {"claims", claims_table(for_figures(runs), paper_claims())},
          {"sweeps", sweep_cost_table(runs, all_sets())},
          {"figures", figure_cost_table(runs)}};
}

}  // namespace shaken::study
