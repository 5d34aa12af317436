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
  // 99 is that of a run which has stopped with a checkpoint (run/worker_main.cpp).
  kInterrupted = 130,  ///< Ctrl-C, as the shell has it for a program that the signal ends
};

/// Ends the verb: the message goes to stderr, the code to the shell. A program of one action per call has no better
/// place to handle these than its end, so they travel there as an exception.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

}  // namespace shaken::client
