#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/queue/job.h"
#include "server/queue/stop_rule.h"

namespace shaken::server {

/// The names of executors, in sweeps and in the queue.
inline constexpr std::string_view kLocal = "local";
inline constexpr std::string_view kSlurm = "slurm";

/// The terms on which the jobs of a submission run; what is left out does not bind. A job that was asked for several
/// times obeys the terms of the last sweep that asked for it.
struct Terms {
  /// Wall time of one attempt, after which a run gives way to those that wait; 0: never.
  std::chrono::milliseconds soft_limit{0};
  /// Wall time of all attempts of a run together, after which it is timed out; 0: never.
  std::chrono::milliseconds time_limit{0};
  /// Jobs of the sweep that may run at once; 0: any number.
  int at_most = 0;
  /// What must be done before the first job of the sweep starts.
  std::vector<Target> after{};
  /// When the jobs of the sweep that are still queued are held.
  std::optional<StopRule> stop_if{};
  /// Where the jobs run; empty: where those of the daemon do.
  std::string executor{};
  /// What is asked of that executor, as JSON; empty: nothing.
  std::string settings{};
};

/// Which jobs an executor takes: those whose sweep names it, and, if it is the daemon's default, those whose sweep
/// names none.
struct ExecutorRole {
  std::string name = std::string(kLocal);
  bool is_default = true;
};

/// What a sweep asks of the executor where its jobs run.
struct ExecutorRequest {
  ExecutorRole executor{};
  std::string settings{};  ///< see Terms
};

}  // namespace shaken::server
