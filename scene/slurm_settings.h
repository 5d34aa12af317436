// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/document.h"
#include "scene/problem.h"

namespace shaken::scene {

/// What the runs of a sweep ask of Slurm. What is empty or 0 is left to the daemon and to Slurm.
struct SlurmSettings {
  std::string partition;
  std::string account;
  double time = 0;                   ///< of a task, after which Slurm ends it [s]
  std::string memory;                ///< of a task, as Slurm writes it: "4G"
  int runs_per_task = 0;             ///< that a task does one after the other
  std::vector<std::string> options;  ///< of sbatch

  friend bool operator==(const SlurmSettings&, const SlurmSettings&) = default;
};

/// All that is known of one key of them: what reads, checks, suggests or documents these keys asks this table.
struct SlurmKey {
  std::string name;
  std::string doc;       ///< one line
  std::string allowed;   ///< in words
  std::string fallback;  ///< in words
  nlohmann::ordered_json schema;
  void (*read)(const Node& node, SlurmSettings& settings, std::vector<Problem>& problems);
};
const std::vector<SlurmKey>& slurm_keys();

/// Reads the object "slurm" of a sweep.
SlurmSettings read_slurm_settings(const Node& node, std::vector<Problem>& problems);

/// Why sbatch is not given this option, as a sentence; none if it is.
std::optional<std::string> slurm_option_problem(std::string_view option);

/// What a sweep may name as its executor.
const std::vector<std::string>& executor_names();

/// As one line of JSON; and back, from such a line or from an empty text.
std::string to_text(const SlurmSettings& settings);
SlurmSettings slurm_settings(const std::string& text);

/// The reference of the keys as a Markdown table (docs/cluster.md).
std::string slurm_keys_as_markdown();

}  // namespace shaken::scene
