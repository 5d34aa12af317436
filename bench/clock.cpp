// SPDX-License-Identifier: MIT
#include "bench/clock.h"

#include <algorithm>
#include <cstdint>
#include <ctime>

namespace shaken::bench {
namespace {

double read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of one reading of this thread's clock, the least of several batches [s].
double cost_of_reading() {
  constexpr int kBatches = 20;
  constexpr int kReadings = 2000;
  double least = 1;
  for (int batch = 0; batch < kBatches; ++batch) {
    const double start = read_clock(CLOCK_THREAD_CPUTIME_ID);
    double last = start;
    for (int i = 0; i < kReadings; ++i) last = read_clock(CLOCK_THREAD_CPUTIME_ID);
    least = std::min(least, (last - start) / kReadings);
  }
  return least;
}

}  // namespace

double cpu_seconds() { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

double cpu_seconds_without_readings() {
  static const double cost = cost_of_reading();
  static std::int64_t readings = 0;
  return read_clock(CLOCK_THREAD_CPUTIME_ID) - cost * static_cast<double>(readings++);
}

double wall_seconds() { return read_clock(CLOCK_MONOTONIC); }

}  // namespace shaken::bench
