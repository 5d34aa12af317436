// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/core/result.h"

namespace shaken::server {

/// A worker to be started.
struct Launch {
  std::filesystem::path directory;     ///< of the run; what the worker prints goes to worker.log there
  std::vector<std::string> arguments;  ///< the command line after the program's name
  std::string heading;                 ///< line that precedes the output of this attempt in the log
};

/// How a worker ended.
struct WorkerEnd {
  int exit_code = 0;
  int signal = 0;  ///< that killed it; 0 if it ended by itself
};

/// Where workers run. Not for several threads.
class Executor {
 public:
  virtual ~Executor() = default;

  /// Starts a worker; returns what names it from now on (for a local process its pid).
  virtual Result<int> start(const Launch& launch) = 0;
  /// How it ended, told once; none while it runs.
  virtual std::optional<WorkerEnd> poll(int worker) = 0;
  /// Asks it to write a checkpoint and end with exit code 99.
  virtual void stop(int worker) = 0;
  /// Ends it at once, with everything it has started.
  virtual void kill(int worker) = 0;
};

}  // namespace shaken::server
