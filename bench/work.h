#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/report.h"
#include "bench/timing.h"

namespace shaken::bench {

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

}  // namespace shaken::bench
