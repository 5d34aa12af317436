#include "base/slurm_conf.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

namespace shaken {
namespace {

std::string named() {
  const char* file = std::getenv("SLURM_CONF");
  return file != nullptr ? file : "";
}

}  // namespace

std::string slurm_conf_text() {
  const std::string file = named();
  if (file.empty()) return "SLURM_CONF is not set";
  return "SLURM_CONF=" + file + (missing_slurm_conf() ? ", where there is no file" : "");
}

std::optional<std::string> missing_slurm_conf() {
  const std::string file = named();
  std::error_code error;
  if (file.empty() || std::filesystem::exists(file, error)) return std::nullopt;
  return file;
}

void forget_slurm_filters() {
  static constexpr std::array<std::string_view, 11> kNames{"SLURM_CLUSTERS",   "SBATCH_CLUSTERS",  "SLURM_TIME_FORMAT",
                                                           "SLURM_BITSTR_LEN", "SBATCH_WAIT",      "SBATCH_TEST_ONLY",
                                                           "SBATCH_ERROR",     "SBATCH_INPUT",     "SBATCH_OUTPUT",
                                                           "SBATCH_ARRAY_INX", "SBATCH_DEPENDENCY"};
  std::vector<std::string> names;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    const std::string_view name = variable.substr(0, variable.find('='));
    if (name.starts_with("SQUEUE_") || name.starts_with("SCANCEL_") || name.starts_with("SINFO_") ||
        std::find(kNames.begin(), kNames.end(), name) != kNames.end()) {
      names.emplace_back(name);
    }
  }
  for (const std::string& name : names) unsetenv(name.c_str());
}

}  // namespace shaken
