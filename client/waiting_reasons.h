#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/live/json.h"

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

}  // namespace shaken::client
