#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shaken::client {

/// One thing that `shaken doctor` has looked at.
struct CheckResult {
  enum class Level { kOk, kWarn, kFail };
  Level level = Level::kOk;
  std::string what;     ///< "plots"
  std::string message;  ///< what was found
  std::string remedy;   ///< a command, or a sentence; empty if nothing is to be done
};

/// Looks at everything that Shaken needs on this machine: programs beside this one, daemon, live state, off-screen
/// drawing, plots, disk and cores. What makes simulating impossible is kFail, what makes a part of it unavailable
/// kWarn.
std::vector<CheckResult> checkup(const std::filesystem::path& root);

/// Looks at what runs in Slurm need besides: its programs here, a controller that answers, arrays that are large
/// enough, and nodes that see the daemon's root and Shaken's programs. The last starts a moment's job, if a node is
/// free.
std::vector<CheckResult> slurm_checkup(const std::filesystem::path& root);

}  // namespace shaken::client
