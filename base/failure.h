// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace shaken {

/// How a program ends; part of its interface (`shaken --help` lists them).
enum class ExitCode : int {
  kOk = 0,
  kFailed = 1,         ///< the work was understood but did not succeed
  kBadInput = 2,       ///< wrong arguments, a refused scene, an ID that names nothing
  kNoDaemon = 3,       ///< nobody listens on the socket
  kStopped = 99,       ///< a run has stopped with a checkpoint, from which the same command goes on
  kInterrupted = 130,  ///< Ctrl-C, as the shell has it for a program that the signal ends
};

/// Ends a program: the message goes to stderr, the code to the shell. Programs throw it, libraries never do: they
/// return a Result.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

}  // namespace shaken
