// SPDX-License-Identifier: MIT
#include "study/destination.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/text.h"
#include "scene/document.h"
#include "scene/slurm_settings.h"

namespace shaken::study {
namespace {

struct Option {
  const char* key;
  const char* flag;
};
constexpr Option kOptions[] = {
    {"partition", "--partition"}, {"account", "--account"},      {"time", "--time"},
    {"memory", "--memory"},       {"options", "--slurm-option"}, {"runs_per_task", "--runs-per-task"}};

/// What a sweep's "slurm" with this one key would be told.
std::string refusal(const char* key, const Json& value) {
  std::vector<scene::Problem> problems;
  const auto node = scene::parse_document(Json{{key, value}}.dump(), "", problems);
  if (node) scene::read_slurm_settings(*node, problems);
  return problems.empty() ? "" : problems.front().message;
}

}  // namespace

void Destination::declare(client::Arguments& arguments) {
  arguments.option("--executor", executor_, "local|slurm",
                   "Where the runs go; if left out where the sweeps say, or else the daemon");
  arguments.option("--partition", partition_, "NAME", "In Slurm: partition, or several with commas");
  arguments.option("--account", account_, "NAME", "In Slurm: account that is charged");
  arguments.option("--time", time_, "TIME", "In Slurm: wall time of a task (4h); what is left goes on in another");
  arguments.option("--memory", memory_, "SIZE", "In Slurm: memory of a task (2G)");
  arguments.option("--runs-per-task", runs_per_task_, "N", "In Slurm: runs that a task does one after the other");
  arguments.repeatable("--slurm-option", options_, "OPTION",
                       "In Slurm: an option of sbatch, as --slurm-option=--qos=low; repeatable");
}

Json Destination::settings() const {
  Json settings = Json::object();
  if (!partition_.empty()) settings["partition"] = partition_;
  if (!account_.empty()) settings["account"] = account_;
  if (!time_.empty()) settings["time"] = time_;
  if (!memory_.empty()) settings["memory"] = memory_;
  if (runs_per_task_) settings["runs_per_task"] = *runs_per_task_;
  if (!options_.empty()) settings["options"] = options_;
  return settings;
}

std::string Destination::problems() const {
  std::string problems;
  const std::vector<std::string>& known = scene::executor_names();
  if (!executor_.empty() && std::find(known.begin(), known.end(), executor_) == known.end()) {
    problems += fmt::format("--executor takes {}, not '{}'\n", fmt::join(known, " or "), printable(executor_));
  }
  const Json settings = this->settings();
  for (const auto& [key, flag] : kOptions) {
    if (!settings.contains(key)) continue;
    if (!is_slurm()) problems += fmt::format("{} has a meaning with --executor slurm only\n", flag);
    if (const std::string why = refusal(key, settings.at(key)); !why.empty()) {
      problems += fmt::format("{}: {}\n", flag, why);
    }
  }
  return problems;
}

void Destination::redirect(Selection& selection) const {
  if (executor_.empty()) return;
  const Json settings = this->settings();
  for (NamedSweep& sweep : selection.sweeps) {
    sweep.input.text = sent_to(sweep.input.text, executor_, settings);
    sweep.sweep = client::load_points(sweep.input, {}, std::nullopt);
  }
}

std::string sent_to(const std::string& text, const std::string& executor, const Json& settings) {
  const Json given = Json::parse(text, nullptr, true, true);
  const bool is_sweep = given.contains("scene") || given.contains("sweep");
  Json sweep = Json::object();
  if (is_sweep && given.contains("name")) sweep["name"] = given.at("name");
  sweep["executor"] = executor;
  Json slurm = is_sweep ? given.value("slurm", Json::object()) : Json::object();
  if (slurm.is_null()) slurm = Json::object();
  slurm.update(settings);
  if (!slurm.empty()) sweep["slurm"] = std::move(slurm);
  if (is_sweep) {
    for (const auto& [key, value] : given.items()) {
      if (!sweep.contains(key)) sweep[key] = value;
    }
  } else {
    sweep["scene"] = given;
  }
  return sweep.dump(2) + "\n";
}

}  // namespace shaken::study
