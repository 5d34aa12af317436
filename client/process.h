// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shaken::client {

/// The program `name` that was installed beside this one.
std::filesystem::path sibling_program(const std::string& name);

struct ChildResult {
  int exit_code = 0;   ///< 128 + signal if a signal ended it; 127 if it could not be started
  std::string output;  ///< stdout and stderr, in the order written
};

/// Runs `command` (a path, or a name to be found in PATH) in `folder` until it ends, with nothing on its stdin.
ChildResult run_captured(const std::vector<std::string>& command, const std::filesystem::path& folder = ".");

/// Becomes `command`: the caller's terminal, signals and exit code are then its own. Throws Failure if it cannot be
/// started.
[[noreturn]] void become(const std::vector<std::string>& command);

}  // namespace shaken::client
