#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "base/core/result.h"

namespace shaken {

/// How a program ends; part of its interface (`shaken --help` lists them).
enum class ExitCode : int {
  kOk = 0,
  kFailed = 1,         ///< the work was understood but did not succeed
  kBadInput = 2,       ///< wrong arguments, a refused scene, an ID that names nothing
  kNoDaemon = 3,       ///< nobody listens on the socket
  kNoRoom = 97,        ///< a run found no room on the disk; the same command goes on from the last checkpoint
  kSystemFailed = 98,  ///< the system refused a run what it may grant another time: a read, memory, a thread; likewise
  kStopped = 99,       ///< a run has stopped with a checkpoint, from which the same command goes on
  kInterrupted = 130,  ///< by Ctrl-C, as the shell has it for a program that SIGINT ends
  kTerminated = 143,   ///< as it has it for SIGTERM
};

/// Ends a program: the message goes to stderr, the code to the shell. Programs throw it, libraries never do: they
/// return a Result.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& message) : std::runtime_error(message), code(exit_code) {}
  ExitCode code;
};

/// The value of `result`, or Failure with the words of its error.
template <class T>
T value_or_fail(Result<T> result, ExitCode code = ExitCode::kFailed) {
  if (!result) throw Failure(code, result.error().message);
  return std::move(result).value();
}

/// Failure with the words of the error if `result` is one.
inline void done_or_fail(const Result<void>& result, ExitCode code = ExitCode::kFailed) {
  if (!result) throw Failure(code, result.error().message);
}

}  // namespace shaken
