// SPDX-License-Identifier: MIT
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
  enum class Outcome { kDone, kFailed, kStopped };
  Outcome outcome;
  std::string reason;  ///< empty if done
};

/// Exit 0 with a summary is done; exit 99 and SIGTERM are a stop on request, and so is SIGKILL if `stop_asked`;
/// anything else is a failure, explained by what the worker wrote into progress.json or said last in worker.log.
JobEnd judge(const WorkerEnd& end, int pid, bool stop_asked, const run::RunDirectory& directory);

}  // namespace shaken::server
