// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace shaken::server {

/// The terms on which the jobs of a submission run; what is left out does not bind. Those of the last submission hold.
struct Terms {
  /// Wall time of one attempt, after which a run gives way to those that wait; 0: never.
  std::chrono::milliseconds soft_limit{0};
  /// Wall time of all attempts of a run together, after which it is timed out; 0: never.
  std::chrono::milliseconds time_limit{0};
};

/// Why a job is timed out.
std::string time_limit_over(std::chrono::milliseconds limit);

}  // namespace shaken::server
