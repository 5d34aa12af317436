// SPDX-License-Identifier: MIT
#pragma once

namespace shaken::bench {

/// CPU time of this process, all threads together [s]. Other programs on the machine do not count towards it, though
/// they slow it down through what they share: caches, memory, the clock rate.
double cpu_seconds();

/// CPU time of this thread less the time that reading it has taken so far [s]: a reading costs a system call, which
/// would weigh on short phases. Not for several threads at once.
double cpu_seconds_without_readings();

/// Time on the wall [s].
double wall_seconds();

}  // namespace shaken::bench
