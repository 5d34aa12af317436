#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "server/queue/job.h"

namespace shaken::server {

/// The names of executors, in sweeps and in the queue.
inline constexpr std::string_view kLocal = "local";
inline constexpr std::string_view kSlurm = "slurm";

/// When a sweep has failed too often to go on: "failed>10%", of its jobs that have ended by themselves (done, failed or
/// timed out), or "failed>3", a number of jobs.
class StopRule {
 public:
  /// Blanks do not matter. The error says what a rule looks like.
  static Result<StopRule> parse(std::string_view text);

  /// As it is written without blanks; parse() of it gives the rule again.
  std::string text() const;
  /// Whether a sweep with these jobs is to stop. A percentage is judged once five jobs have ended.
  bool is_broken(const JobCounts& counts) const;
  /// "failed>10%: 2 of 7 jobs that ended have failed"
  std::string reason(const JobCounts& counts) const;

 private:
  StopRule(double most, bool is_percentage) : most_(most), is_percentage_(is_percentage) {}
  double most_;
  bool is_percentage_;
};

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
