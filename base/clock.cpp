#include "base/clock.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>

namespace shaken {
namespace {

double read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The time that one reading of this thread's clock takes, the least of several batches [s].
double cost_of_reading() {
  constexpr int kBatches = 20;
  constexpr int kReadings = 2000;
  double least = 1;
  for (int batch = 0; batch < kBatches; ++batch) {
    const double start = thread_cpu_seconds();
    double last = start;
    for (int i = 0; i < kReadings; ++i) last = thread_cpu_seconds();
    least = std::min(least, (last - start) / kReadings);
  }
  return least;
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

std::int64_t utime_now() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

double wall_seconds() { return read_clock(CLOCK_MONOTONIC); }

double cpu_seconds() { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

double thread_cpu_seconds() { return read_clock(CLOCK_THREAD_CPUTIME_ID); }

double TimeWithoutReadings::at(double reading) {
  sum_ += std::max(0.0, reading - last_ - cost_);
  last_ = reading;
  return sum_;
}

double thread_cpu_seconds_without_readings() {
  static const double cost = cost_of_reading();
  static TimeWithoutReadings time(thread_cpu_seconds(), cost);
  return time.at(thread_cpu_seconds());
}

double children_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

double time_of(const std::function<void()>& work, double cpu, int least) {
  const double start = thread_cpu_seconds();
  double taken = 0;
  int calls = 0;
  while (taken < cpu || calls < least) {
    work();
    ++calls;
    taken = thread_cpu_seconds() - start;
  }
  return taken / calls;
}

}  // namespace shaken
