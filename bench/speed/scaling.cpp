// SPDX-License-Identifier: MIT
#include "bench/speed/scaling.h"

#include <algorithm>

#include "base/progress_line.h"

namespace shaken::bench {

Scaling measure_scaling(Scaling::Of of, const std::vector<Case>& scenes, const std::vector<SteadyState>& states,
                        const Effort& effort) {
  Scaling scaling{of, {}};
  std::vector<Tick> ticks;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    scaling.points.push_back({scenes[k], {}});
    ticks.push_back(
        std::max(ticks_for(effort.cpu, scenes[k], states[k], Engine::kScheduled), scenes[k].period_ticks()));
  }
  ProgressLine progress("measuring");
  double done = 0;
  for (int repetition = 0; repetition < effort.repeat; ++repetition) {
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      Simulation simulation = resumed(scenes[k], states[k], Engine::kScheduled);
      advance(simulation, scenes[k].period_ticks());
      time_stretch(simulation, scenes[k], ticks[k], scaling.points[k].speed);
      progress.show(++done / static_cast<double>(effort.repeat * static_cast<int>(scenes.size())));
    }
  }
  return scaling;
}

}  // namespace shaken::bench
