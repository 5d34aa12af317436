#pragma once

#include <string>
#include <string_view>

#include "run/files/directory.h"
#include "server/executor.h"

namespace shaken::server {

/// How the daemon's own lines in a worker.log begin.
inline constexpr std::string_view kHeading = "--- shakend: ";

/// What the end of a worker means for its job.
struct JobEnd {
  enum class Outcome {
    kDone,
    kFailed,       ///< it would fail again: numerical trouble, a bad scene
    kStopped,      ///< at a checkpoint, on request
    kCrashed,      ///< killed or ended without a word: it may go well another time
    kNoRoom,       ///< the disk is full
    kUnconfirmed,  ///< exit 0, but its summary does not say that it is done, or cannot be read at the moment
    kNotStarted,
    kRefused,  ///< by the executor, and it alone
  };
  Outcome outcome;
  std::string reason;  ///< empty if done
};

/// Exit 0 with the summary of run `id` is done, and without it is not confirmed: on a network's disk a file may be seen
/// some seconds after it was written, and what cannot be read is not what is not there. Exit 99 and SIGTERM are a stop
/// on request, and so is SIGKILL if `stop_asked`; exit 97 is a full disk; any other signal is a crash, and so is any
/// other exit code than 1 and 2. These are failures, explained by what the worker wrote into progress.json or said last
/// in worker.log.
JobEnd judge(const WorkerEnd& end, bool stop_asked, const std::string& id, const run::RunDirectory& directory);

}  // namespace shaken::server
