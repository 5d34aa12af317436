#pragma once

#include <optional>
#include <vector>

#include "base/failure.h"
#include "client/console.h"
#include "client/live/api_client.h"
#include "client/live/target.h"

namespace shaken::client {

/// Waits until all jobs of `targets` have ended, with a line of progress on a terminal's stderr, and one for each
/// reason that keeps jobs waiting. kOk only if every job is done; kFailed if one failed or was cancelled (they are
/// named on stderr) and after `timeout_s` seconds, kInterrupted after Ctrl-C: the jobs themselves go on then. A daemon
/// that is restarted meanwhile is waited for, up to 10 s.
ExitCode wait_for(ApiClient& session, std::vector<Target> targets, std::optional<double> timeout_s, Console& console);

}  // namespace shaken::client
