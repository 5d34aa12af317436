#pragma once

#include <cstdint>
#include <functional>

namespace shaken {

/// Microseconds since 1970-01-01 UTC: for people and for the wire. Durations are measured with the other clocks.
std::int64_t utime_now();

/// Time on the wall since some instant [s]; never set back.
double wall_seconds();

/// CPU time of this process, all threads together [s]. Other programs on the machine do not count towards it, though
/// they slow it down through what they share: caches, memory, the clock rate.
double cpu_seconds();

/// CPU time of this thread [s].
double thread_cpu_seconds();

/// Sums the time between readings of a clock, less what one reading costs. An interval that is shorter than that (the
/// cost scatters) counts as none, so that the sum never runs back.
class TimeWithoutReadings {
 public:
  TimeWithoutReadings(double first_reading, double cost) : last_(first_reading), cost_(cost) {}

  /// The sum up to this reading [s].
  double at(double reading);

 private:
  double last_;
  double cost_;
  double sum_ = 0;
};

/// CPU time of this thread without that of reading it, which costs a system call and would weigh on short phases [s].
/// Not for several threads at once.
double thread_cpu_seconds_without_readings();

/// CPU time of the children of this process that have ended [s].
double children_cpu_seconds();

/// CPU time of one call of `work`, the mean over as many as fill `cpu` seconds, at least `least` calls [s].
double time_of(const std::function<void()>& work, double cpu, int least);

}  // namespace shaken
