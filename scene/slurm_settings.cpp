// SPDX-License-Identifier: MIT
#include "scene/slurm_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/nearest.h"
#include "scene/units.h"
#include "scene/values.h"

namespace shaken::scene {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kShortest = 60;     // Slurm counts in minutes
constexpr double kLongest = 31.6e6;  // a year
constexpr int kMostRuns = 10'000;
constexpr std::size_t kMostOptions = 50;

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

std::string path_of(std::string_view key) { return fmt::format("slurm.{}", key); }

void report(const Node& node, std::string_view key, std::string message, std::vector<Problem>& problems) {
  problems.push_back(problem_at(node.place, path_of(key), std::move(message)));
}

/// Letters, digits and what names of partitions and accounts have besides.
bool is_plain(std::string_view word) {
  const auto is_fine = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-.,+@").find(c) != std::string_view::npos;
  };
  return !word.empty() && word.size() <= 200 && word.front() != '-' && std::all_of(word.begin(), word.end(), is_fine);
}

bool is_memory(std::string_view word) {
  const std::size_t digits = std::min(word.find_first_not_of("0123456789"), word.size());
  return digits > 0 && digits <= 9 && word.front() != '0' && word.size() == digits + 1 &&
         std::string_view("KMGT").find(word.back()) != std::string_view::npos;
}

template <class Allowed>
void read_word(const Node& node, std::string_view key, std::string_view expected, Allowed allowed, std::string& word,
               std::vector<Problem>& problems) {
  if (node.kind == Node::Kind::kString && allowed(node.text)) {
    word = node.text;
  } else {
    report(node, key, fmt::format("expected {}, not {}", expected, describe(node)), problems);
  }
}

void read_partition(const Node& node, SlurmSettings& settings, std::vector<Problem>& problems) {
  read_word(node, "partition", "the name of a partition, such as \"short\"", is_plain, settings.partition, problems);
}
void read_account(const Node& node, SlurmSettings& settings, std::vector<Problem>& problems) {
  read_word(node, "account", "the name of an account", is_plain, settings.account, problems);
}
void read_memory(const Node& node, SlurmSettings& settings, std::vector<Problem>& problems) {
  read_word(node, "memory", "a whole number with K, M, G or T, such as \"4G\"", is_memory, settings.memory, problems);
}

void read_time(const Node& node, SlurmSettings& settings, std::vector<Problem>& problems) {
  if (node.kind != Node::Kind::kNumber && node.kind != Node::Kind::kString) {
    return report(node, "time", fmt::format("expected a time such as \"4 h\", not {}", describe(node)), problems);
  }
  const Result<double> time = parse_quantity(node.text, Dimension::kTime);
  if (!time) return report(node, "time", time.error().message, problems);
  if (*time < kShortest || *time > kLongest) {
    return report(node, "time", fmt::format("{} is outside [1, 526666] min", node.text), problems);
  }
  settings.time = *time;
}

void read_runs_per_task(const Node& node, SlurmSettings& settings, std::vector<Problem>& problems) {
  settings.runs_per_task = read_count(path_of("runs_per_task"), node, 1, kMostRuns, problems).value_or(0);
}

void read_options(const Node& node, SlurmSettings& settings, std::vector<Problem>& problems) {
  if (node.kind != Node::Kind::kArray || node.items.size() > kMostOptions) {
    return report(node, "options",
                  fmt::format("expected an array of at most {} texts, not {}", kMostOptions, describe(node)), problems);
  }
  for (const Node& item : node.items) {
    if (item.kind != Node::Kind::kString) {
      report(item, "options", fmt::format("expected a text such as \"--constraint=avx2\", not {}", describe(item)),
             problems);
    } else if (const auto problem = slurm_option_problem(item.text)) {
      report(item, "options", *problem, problems);
    } else {
      settings.options.push_back(item.text);
    }
  }
}

Json text_schema(const std::string& pattern) { return {{"type", "string"}, {"pattern", pattern}}; }

}  // namespace

const std::vector<SlurmKey>& slurm_keys() {
  static const std::vector<SlurmKey> kKeys{
      {"partition", "Partition, or several with commas.", "text", "that of Slurm",
       text_schema("^[A-Za-z0-9_.,+@][A-Za-z0-9_.,+@-]*$"), read_partition},
      {"account", "Account that is charged.", "text", "that of Slurm",
       text_schema("^[A-Za-z0-9_.,+@][A-Za-z0-9_.,+@-]*$"), read_account},
      {"time",
       "Wall time of a task, after which Slurm ends it. Its runs write a checkpoint shortly before, and go on in "
       "another "
       "task. Slurm counts whole minutes; what is left over is rounded up.",
       "1 min to a year", "that of the partition", Json{{"type", Json::array({"string", "number"})}}, read_time},
      {"memory", "Memory of a task.", "whole number with K, M, G or T", "that of the partition",
       text_schema("^[1-9][0-9]{0,8}[KMGT]$"), read_memory},
      {"runs_per_task", "Runs that a task does, one after the other: some minutes of work for each task are good.",
       fmt::format("whole, 1 to {}", kMostRuns), "that of the daemon (`--runs-per-task`)",
       Json{{"type", "integer"}, {"minimum", 1}, {"maximum", kMostRuns}}, read_runs_per_task},
      {"options", "Further options of sbatch, each a text that begins with `--`, with its value behind `=`.",
       fmt::format("list of at most {} texts", kMostOptions), "none",
       Json{{"type", "array"}, {"maxItems", kMostOptions}, {"items", text_schema("^--[a-z]")}}, read_options}};
  return kKeys;
}

SlurmSettings read_slurm_settings(const Node& node, std::vector<Problem>& problems) {
  SlurmSettings settings;
  if (node.kind != Node::Kind::kObject) {
    problems.push_back(problem_at(node.place, "slurm", "expected an object, not " + describe(node)));
    return settings;
  }
  std::vector<std::string> names;
  names.reserve(slurm_keys().size());
  for (const SlurmKey& key : slurm_keys()) names.push_back(key.name);
  for (const Member& member : node.members) {
    const auto key = std::find(names.begin(), names.end(), member.key);
    if (key == names.end()) {
      const std::string meant = suggestion(problems, [&] { return did_you_mean(nearest(member.key, names)); });
      problems.push_back(problem_at(member.place, path_of(member.key), "unknown key" + meant));
    } else if (member.value.kind != Node::Kind::kNull) {
      slurm_keys()[static_cast<std::size_t>(key - names.begin())].read(member.value, settings, problems);
    }
  }
  return settings;
}

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

const std::vector<std::string>& executor_names() {
  static const std::vector<std::string> kNames{"local", "slurm"};
  return kNames;
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

std::string slurm_keys_as_markdown() {
  std::string table = "| key | meaning | allowed | default |\n|---|---|---|---|\n";
  for (const SlurmKey& key : slurm_keys()) {
    table += fmt::format("| `slurm.{}` | {} | {} | {} |\n", key.name, key.doc, key.allowed, key.fallback);
  }
  return table;
}

}  // namespace shaken::scene
