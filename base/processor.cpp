#include "base/processor.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "base/core/cgroup.h"

namespace shaken {

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown CPU";
}

std::optional<double> cores_of_quota(std::string_view text) {
  std::istringstream words{std::string(text)};
  double quota = 0, period = 0;
  if (words >> quota >> period && quota > 0 && period > 0) return quota / period;
  return std::nullopt;
}

int allowed_cores() {
  cpu_set_t cores;
  double allowed =
      sched_getaffinity(0, sizeof(cores), &cores) == 0 ? CPU_COUNT(&cores) : std::thread::hardware_concurrency();
  const auto text_of = [](const std::filesystem::path& file) {
    std::string line;
    std::getline(std::ifstream(file) >> std::ws, line);
    return line;
  };
  for (const auto& file : own_cgroup_files({"cpu", "cpu.max", "cpu.cfs_quota_us"})) {
    const bool is_v1 = file.filename() == "cpu.cfs_quota_us";
    const std::string period = is_v1 ? " " + text_of(file.parent_path() / "cpu.cfs_period_us") : "";
    if (const auto quota = cores_of_quota(text_of(file) + period)) allowed = std::min(allowed, std::ceil(*quota));
  }
  return std::max(1, static_cast<int>(allowed));
}

}  // namespace shaken
