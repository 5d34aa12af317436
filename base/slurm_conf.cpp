// SPDX-License-Identifier: MIT
#include "base/slurm_conf.h"

#include <cstdlib>
#include <filesystem>

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

}  // namespace shaken
