// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

namespace shaken::server {

/// Microseconds since 1970-01-01 UTC: for people and for the wire. Durations are measured with steady_clock.
inline std::int64_t utime_now() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace shaken::server
