// The rules of the queue: what becomes of a job when something happens to it (the table of rules.cpp), and the numbers
// and sentences that go with it. Nothing here knows of files, clocks or threads.
//
// Beyond the table:
// - *Order.* Ready jobs start by priority, the larger number first, then by the time at which they came to wait. A job
//   is ready if it is queued, no pause of its own lasts, it waits for no prerequisite, its sweep has fewer jobs at work
//   than it may (`at_most`), and its executor has not just refused what its sweep asks of it.
// - *Prerequisites (`--after`).* Jobs wait until all that their sweep comes after is done. If some of that comes to
//   nothing, those that are queued are held; they wait on if it is tried again, and start all the same if resumed.
// - *Starts.* A job that begins at the end of another run waits until that is done. It is held if nothing comes of it,
//   and goes on waiting if it is tried again; resumed, it is held again as long as there is nothing to start from.
//   While it waits, that run keeps its end. Once begun, it goes on from its own state.
// - *Soft limit.* A job is preempted only if more ready jobs, of at least its priority, need a slot than others stop.
// - *Time limit.* All attempts count together. A retry, or a submission once more, begins the count anew.
// - *Stop rule (`--stop-if`).* Looked at whenever a job of the sweep ends by itself. It holds the queued jobs of the
//   sweep; resuming the sweep lifts it.
// - *Crashes in a row.* Each is followed by a longer pause, until there is none left. A checkpoint ends the row.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "server/queue/job.h"

namespace shaken::server {

enum class JobEvent {
  // what users ask for
  kCancel,
  kHold,
  kResume,
  kRetry,
  kSubmitAgain,
  kResultsLost,  ///< submitted again, and its results are not there any more
  kExtend,       ///< to go on for longer than it did
  kClean,        ///< its results are removed
  // what the supervisor decides
  kLaunch,
  kRefuseScene,
  kSoftLimit,
  kTimeLimit,
  kShutDown,  ///< of the daemon, with which its worker ends
  // how its worker ends
  kWorkerDone,
  kWorkerFailed,
  kWorkerStopped,
  kWorkerCrashed,
  kCrashedTooOften,
  kNoRoom,
  // what happens to others
  kRoomAgain,
  kPrerequisiteFailed,
  kPrerequisiteRetried,
  kStopRuleMet,
};

/// The phase that follows; none where nothing changes. Throws std::logic_error where the event cannot happen: the
/// worker of a job that has none does not end.
std::optional<JobPhase> next_phase(JobPhase phase, JobEvent event);

/// How the queue's file has a phase: hold and after_stop are empty but for held and stopping jobs.
struct StoredPhase {
  JobState state;
  std::string_view hold, after_stop;
};
StoredPhase stored(JobPhase phase);
/// The phase of such a row, the first of its state if the row says no more; none if it says what is unknown.
std::optional<JobPhase> phase_of(JobState state, std::string_view hold, std::string_view after_stop);

/// Nobody waits any more for what was asked of the job: it goes by what it is asked for next, be that less.
bool is_withdrawn(JobPhase phase);
/// The first state of these counts in which there are jobs that came to nothing.
std::optional<JobState> state_without_result(const JobCounts& counts);
/// Before what was refused `times` times in a row is tried again.
std::chrono::milliseconds refusal_pause(std::chrono::milliseconds first, int times);

inline constexpr std::string_view kCancelledOnRequest = "cancelled on request";
inline constexpr std::string_view kHeldOnRequest = "held on request";
inline constexpr std::string_view kCleanedOnRequest = "cleaned on request";
/// Why a job is timed out.
std::string time_limit_text(std::chrono::milliseconds limit);

}  // namespace shaken::server
