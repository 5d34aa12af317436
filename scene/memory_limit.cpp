#include "scene/memory_limit.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "base/core/cgroup.h"
#include "scene/keys/observables.h"

namespace shaken::scene {

namespace {

std::string bytes_shown(double bytes) {
  static constexpr std::array kUnits{"kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (bytes /= 1000; bytes >= 999.5 && unit + 1 < kUnits.size(); bytes /= 1000) ++unit;
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

}  // namespace

double memory_allowed() {
  double allowed = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    allowed = std::min(allowed, static_cast<double>(limit.rlim_cur));
  }
  for (const auto& file : own_cgroup_files({"memory", "memory.max", "memory.limit_in_bytes"})) {
    double bytes = 0;  // no number there ("max"), or no file: no limit
    if (std::ifstream(file) >> bytes && bytes > 0) allowed = std::min(allowed, bytes);
  }
  return allowed;
}

std::optional<Problem> memory_problem(const RunPlan& plan, double allowed, const std::string& file,
                                      const std::string& label) {
  const std::map<std::string, MeasureMemory> memory = measure_memory(plan);
  const double peak = peak_of(memory);
  if (peak <= allowed) return std::nullopt;
  const auto alone = [](const auto& one) { return peak_of({one}); };
  const auto largest = std::ranges::max_element(memory, {}, alone);
  return Problem{file, 0, 0, "/measure/" + largest->first,
                 fmt::format("{}the measurements of this run would take about {} of memory, {} alone {}, and a process "
                             "may have {} here; smaller with {}",
                             label.empty() ? "" : label + ": ", bytes_shown(peak), largest->first,
                             bytes_shown(alone(*largest)), bytes_shown(allowed), observable(largest->first).remedy)};
}

}  // namespace shaken::scene
