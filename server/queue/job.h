#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/job_state.h"

namespace shaken::server {

/// A state as the rules have it: what holds a held job, and what a stopping one becomes, make a difference.
enum class JobPhase {
  kQueued,
  kHeldOnRequest,
  kHeldForRoom,    ///< on the disk
  kHeldForOthers,  ///< what it was to come after was not done
  kHeldByRule,     ///< the stop rule of its sweep is met
  kRunning,
  kStopToQueue,
  kStopToLast,  ///< to be queued behind all of its priority
  kStopToCancel,
  kStopToHold,
  kStopToTimeOut,
  kDone,
  kFailed,
  kTimedOut,
  kCancelled,
};

/// Number of jobs in each state.
struct JobCounts {
  std::array<std::int64_t, kJobStates.size()> n{};
  std::int64_t& operator[](JobState state) { return n[static_cast<std::size_t>(state)]; }
  std::int64_t operator[](JobState state) const { return n[static_cast<std::size_t>(state)]; }
  std::int64_t total() const;
  /// In the states that are so.
  std::int64_t of(bool (*are_so)(JobState)) const;
};

/// One run of one scene. Times are microseconds since 1970-01-01 UTC, 0 where the event has not happened.
struct Job {
  std::string id;          ///< hash of the canonical scene: 16 hex digits
  std::int64_t sweep = 0;  ///< through which it is looked at; otherwise the last that asked for it
  JobState state = JobState::kQueued;
  JobPhase phase = JobPhase::kQueued;  ///< of that state
  std::string reason;      ///< why it failed, is held or was cancelled, or what keeps a queued one waiting; or empty
  std::string label;       ///< its swept parameters, as words
  std::string parameters;  ///< its swept parameters, as a JSON object
  int replica = 0;
  int priority = 0;
  int attempt = 0;  ///< how often it was started
  int pid = 0;      ///< of its worker on this machine while running or stopping, otherwise 0
  std::int64_t created = 0;
  std::int64_t started = 0;  ///< the last attempt
  std::int64_t finished = 0;
  std::int64_t not_before = 0;   ///< a queued job that has crashed, or is refused where it is to run, waits until then
  std::int64_t asked_by = 0;     ///< the sweep that asked for it last, whose terms it obeys
  bool waits = false;            ///< until what that sweep comes after is done
  bool waits_for_start = false;  ///< for the run from whose end it begins, which is not done; follows from that run
  std::chrono::milliseconds soft_limit{0};  ///< see Terms
  std::chrono::milliseconds time_limit{0};
  /// Wall time of its attempts since it was submitted or retried last; of the present one, all but the last seconds.
  std::chrono::milliseconds wall{0};
  int crashes = 0;            ///< in a row, without a checkpoint between them
  bool longer = false;        ///< asked to go on for longer than its worker knows
  std::string worker{};       ///< by which a worker that outlives the daemon is found
  std::string starts_from{};  ///< the id of a run whose end it begins at; empty: none
  double work = 1;            ///< rods times simulated seconds; a unit costs more of dense rods and short steps
};

/// An ordered list of jobs asked for together.
struct Sweep {
  std::int64_t id = 0;
  std::string name;
  std::int64_t created = 0;  ///< microseconds since 1970-01-01 UTC
  JobCounts counts;
  int at_most = 0;                   ///< see Terms
  std::vector<std::string> after{};  ///< "s3", or the id of a job
  std::string stop_if{};             ///< as StopRule::text(); empty: none
  bool stopped = false;              ///< by that rule
  std::string executor{};            ///< see Terms
  std::string settings{};
};

/// What a request concerns: one job, by its id, or all jobs of a sweep, by its number.
using Target = std::variant<std::string, std::int64_t>;

/// "s12" for sweep 12; and back.
std::string sweep_word(std::int64_t id);
std::optional<std::int64_t> sweep_number(std::string_view word);

/// "s12", or the id of a job; and back.
std::string to_word(const Target& target);
Target target_named(const std::string& word);

}  // namespace shaken::server
