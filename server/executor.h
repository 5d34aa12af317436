#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.h"

namespace shaken::server {

/// A worker to be started.
struct Launch {
  std::filesystem::path directory;     ///< of the run; what the worker prints goes to worker.log there
  std::vector<std::string> arguments;  ///< the command line after the program's name
  std::string heading;                 ///< line that precedes the output of this attempt in the log
  std::string settings{};              ///< what the sweep asks of the executor, as JSON; empty: nothing
};

/// How a worker ended.
struct WorkerEnd {
  int exit_code = 0;
  int signal = 0;  ///< that killed it; 0 if it ended by itself
  int pid = 0;     ///< that it had, where it ran
};

/// What an executor knows of a worker.
struct WorkerReport {
  enum class Phase {
    kWaiting,  ///< it has been handed over, and waits for its turn; `words` say for what
    kWorking,
    kEnded,    ///< see `end`
    kRevoked,  ///< it has ended, through no fault of its own: what it ran on was taken away; `words` say why
    kLost,     ///< it has ended, and nobody knows how; `words` say what is known
    kRefused,  ///< it could not be handed over; `words` say why
  };
  Phase phase = Phase::kWorking;
  std::string words{};
  WorkerEnd end{};
};

/// Where workers run. Not for several threads.
class Executor {
 public:
  virtual ~Executor() = default;

  /// How many more workers it takes at the moment.
  virtual int room() const { return std::numeric_limits<int>::max(); }
  /// Why it takes nothing at the moment, where that is its own trouble; else empty.
  virtual std::string trouble() const { return {}; }
  /// Takes a worker, and returns what names it from now on (for a local process its pid).
  virtual Result<int> start(const Launch& launch) = 0;
  /// What is known of it; its end is told once.
  virtual WorkerReport poll(int worker) = 0;
  /// Asks it to write a checkpoint and end with exit code 99; one that waits ends without having begun.
  virtual void stop(int worker) = 0;
  /// Ends it at once, with everything it has started.
  virtual void kill(int worker) = 0;

  /// Lets what was asked for go on, as far as that is possible without waiting.
  virtual void step() {}
  /// By what a worker is found again after a restart of the daemon; empty where workers end with it.
  virtual std::string name(int /*worker*/) const { return {}; }
  /// The worker of that name, which a former daemon has started; none if it was never handed over.
  virtual std::optional<int> adopt(const std::string& /*name*/) { return std::nullopt; }
};

}  // namespace shaken::server
