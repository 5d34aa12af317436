#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/report.h"
#include "bench/timing.h"

namespace shaken::bench {

/// How figures of speed came about.
struct Conditions {
  Effort effort;
  double warm_up = 0;  ///< [s]
  /// Shorter than this, the rods still stand much as they were placed: figures are then not of the steady state.
  static constexpr double kSteady = 5.0;
  bool steady() const { return warm_up >= kSteady; }
};

/// What the scheduled stepper does on a scene to know where to look, and where its time goes.
struct CountedWork {
  double rod_seconds = 0;
  std::array<std::int64_t, kWorkKinds> counts{};
  std::array<double, kPhases> phases{};  ///< CPU time [s]
  double cpu = 0;                        ///< of the whole stretch [s]
  double in_loops = 0;                   ///< of this, what several threads would share [s]

  double serial_share() const { return 1 - in_loops / cpu; }
};

/// From a run of the contender of its own, by one thread and without the clock's time.
CountedWork count_work(const Contender& of);

/// Members of a row: the counts "per_rod_second", the "ns" of CPU time that each costs, "phase_shares" of the CPU time.
Json json_of(const CountedWork& work);

/// Tables of these, whose lines begin with the columns `scene`.
std::string work_text(const Json& rows, const std::vector<Column>& scene);

/// What is compared: both steppers on each scene, or the scheduled one by kind of scene, by the number of rods, by the
/// step, by the number of threads.
enum class Comparison { kSteppers, kKinds, kRods, kStep, kThreads };

/// Rows of what was timed in turn, each relative to the first, with what the scheduled stepper did.
Json rate_row(const Contender& of, const Contender& first, const CountedWork& work);

/// A row of both steppers on one scene. Their states after `compared_ticks` must be the same.
Json steppers_row(const Contender& scheduled, const Contender& reference, const CountedWork& work, Tick compared_ticks,
                  std::uint64_t scheduled_hash);

/// A row of so many threads, which must not change the state. No number of them can exceed the speed-up "limit" if they
/// share all but the serial part of the work evenly (Amdahl 1967).
Json threads_row(const Contender& of, const Contender& first, const CountedWork& work);

/// The rows of a comparison, as files and for people.
Report rates_report(const Conditions& conditions, Comparison of, const Json& rows);

/// Throws Failure, "SCENE: WHAT after 1250 ticks", for the first row in which states that must be equal are not.
void check_states(const Report& report, const std::string& what);

}  // namespace shaken::bench
