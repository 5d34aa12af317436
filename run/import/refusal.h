#pragma once

#include <string>
#include <vector>

#include "base/failure.h"
#include "base/keys/problem.h"

namespace shaken::run {

/// Says on stdout, as JSON, all that is wrong with a file and its scene; without `json` it throws a Failure that does,
/// "FILE is refused:" and a line for each.
ExitCode refuse(const std::string& file, const std::vector<keys::Problem>& problems, bool json);

}  // namespace shaken::run
