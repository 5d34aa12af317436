// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace shaken::client {

/// How the program ends; part of its interface (`shaken --help` lists them).
enum class ExitCode : int {
  kOk = 0,
  kFailed = 1,    ///< the work was understood but did not succeed
  kBadInput = 2,  ///< wrong arguments, a refused scene, an ID that names nothing
  kNoDaemon = 3,  ///< nobody listens on the socket
};

/// Ends the verb: the message goes to stderr, the code to the shell. A program of one action per call has no better
/// place to handle these than its end, so they travel there as an exception.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

}  // namespace shaken::client
