#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Why sbatch is not given this option, as a sentence; none if it is.
std::optional<std::string> slurm_option_problem(std::string_view option);

/// As one line of JSON; and back, from such a line or from an empty text.
std::string to_text(const SlurmSettings& settings);
SlurmSettings slurm_settings(const std::string& text);

}  // namespace shaken::scene
