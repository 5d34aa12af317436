#include "scene/sweeps/slurm_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace shaken::scene {
namespace {

using Json = nlohmann::ordered_json;

/// Options that the daemon sets, or without which it could not find its jobs again.
constexpr std::array<std::string_view, 24> kReserved{"--array",
                                                     "--batch",
                                                     "--chdir",
                                                     "--clusters",
                                                     "--cpus-per-task",
                                                     "--error",
                                                     "--help",
                                                     "--hold",
                                                     "--input",
                                                     "--job-name",
                                                     "--kill-on-invalid-dep",
                                                     "--nodes",
                                                     "--no-requeue",
                                                     "--ntasks",
                                                     "--open-mode",
                                                     "--output",
                                                     "--parsable",
                                                     "--requeue",
                                                     "--signal",
                                                     "--test-only",
                                                     "--usage",
                                                     "--version",
                                                     "--wait",
                                                     "--wrap"};

}  // namespace

std::optional<std::string> slurm_option_problem(std::string_view option) {
  constexpr std::size_t kLongestOption = 1000;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; };
  const std::string_view name = option.substr(0, option.find('='));
  if (!name.starts_with("--") || name.size() < 4 || !std::all_of(name.begin(), name.end(), is_letter)) {
    return "an option begins with -- and a name, and its value follows behind =: \"--constraint=avx2\"";
  }
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (option.size() > kLongestOption || std::any_of(option.begin(), option.end(), is_control)) {
    return fmt::format("an option has at most {} bytes, and no line breaks or other control characters",
                       kLongestOption);
  }
  // sbatch takes any beginning of a name for the name
  const auto means = [&](std::string_view reserved) { return reserved.starts_with(name); };
  if (const auto* found = std::find_if(kReserved.begin(), kReserved.end(), means); found != kReserved.end()) {
    return fmt::format("{} is set by the daemon", *found);
  }
  return std::nullopt;
}

std::string to_text(const SlurmSettings& settings) {
  if (settings == SlurmSettings{}) return "";
  return Json{{"partition", settings.partition},
              {"account", settings.account},
              {"time_s", settings.time},
              {"memory", settings.memory},
              {"runs_per_task", settings.runs_per_task},
              {"options", settings.options}}
      .dump();
}

SlurmSettings slurm_settings(const std::string& text) {
  SlurmSettings settings;
  const Json json = text.empty() ? Json::object() : Json::parse(text);
  settings.partition = json.value("partition", "");
  settings.account = json.value("account", "");
  settings.time = json.value("time_s", 0.0);
  settings.memory = json.value("memory", "");
  settings.runs_per_task = json.value("runs_per_task", 0);
  settings.options = json.value("options", std::vector<std::string>{});
  return settings;
}

}  // namespace shaken::scene
