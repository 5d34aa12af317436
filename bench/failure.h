// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace shaken::bench {

/// How a bench ends: the same codes as the client's.
enum class ExitCode : int {
  kOk = 0,
  kFailed = 1,    ///< a check did not hold, or the work could not be finished
  kBadInput = 2,  ///< wrong arguments
};

/// Ends the bench: the message goes to stderr, the code to the shell.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

}  // namespace shaken::bench
