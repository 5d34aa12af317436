#pragma once

#include <string>
#include <vector>

#include "base/failure.h"
#include "client/console.h"
#include "client/verb.h"

namespace shaken::client {

/// The whole program: reads the arguments (without the program's name), runs the one of `verbs`, prints errors.
ExitCode run_program(const std::vector<std::string>& arguments, Console& console, Verbs verbs);

}  // namespace shaken::client
