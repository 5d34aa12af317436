#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/failure.h"
#include "client/console.h"
#include "client/live/api_client.h"
#include "client/live/target.h"

namespace shaken::client {

/// What keeps jobs that somebody waits for, in lines for people: each reason once, when it has stood for some seconds,
/// and again if it comes back after a minute or more. Reasons that differ in their numbers only are the same.
class WaitingReasons {
 public:
  using Clock = std::chrono::steady_clock;

  /// Takes the jobs as they are now, each once; returns what there is to tell, such as
  /// "3 jobs queued: could not be started: ...".
  std::vector<std::string> news(const std::vector<Json>& jobs, Clock::time_point now = Clock::now());

 private:
  struct Reason {
    Clock::time_point first;
    Clock::time_point last;
    bool shown = false;
  };
  std::map<std::string, Reason> seen_;  ///< by the line without its numbers
};

/// Waits until all jobs of `targets` have ended, with a line of progress on a terminal's stderr, and one for each
/// reason that keeps jobs waiting. kOk only if every job is done; kFailed if one failed or was cancelled (they are
/// named on stderr) and after `timeout_s` seconds, kInterrupted after Ctrl-C: the jobs themselves go on then. A daemon
/// that is restarted meanwhile is waited for, up to 10 s.
ExitCode wait_for(ApiClient& session, std::vector<Target> targets, std::optional<double> timeout_s, Console& console);

}  // namespace shaken::client
