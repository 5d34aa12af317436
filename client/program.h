#pragma once

#include <string>
#include <vector>

#include "base/failure.h"
#include "client/console.h"

namespace shaken::client {

/// The whole program: reads the arguments (without the program's name), runs the verb, prints errors.
ExitCode run_program(const std::vector<std::string>& arguments, Console& console);

}  // namespace shaken::client
