// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace shaken::client {

/// Whether `id` of the command line is the path of a run directory rather than the ID of a job: `shaken run` makes
/// such directories without any daemon knowing of them.
bool is_run_directory(const std::string& id);

}  // namespace shaken::client
