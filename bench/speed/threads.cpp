// SPDX-License-Identifier: MIT
#include "bench/speed/threads.h"

#include <algorithm>

#include "base/progress_line.h"

namespace shaken::bench {

bool ThreadsSpeed::hashes_equal() const {
  return std::all_of(points.begin(), points.end(), [&](const Point& p) { return p.hash == points.front().hash; });
}

ThreadsSpeed measure_threads(const Case& scene, const SteadyState& state, const std::vector<int>& threads,
                             const Effort& effort) {
  ThreadsSpeed result{scene, {}};
  for (const int n : threads) result.points.push_back({n, {}, 0});
  const Tick ticks = std::max(ticks_for(effort.cpu, scene, state, Engine::kScheduled), scene.period_ticks());
  ProgressLine progress("measuring threads on " + scene.label());
  double done = 0;
  for (int repetition = 0; repetition < effort.repeat; ++repetition) {
    for (ThreadsSpeed::Point& point : result.points) {
      Simulation simulation = resumed(scene, state, Engine::kScheduled);
      simulation.use_threads(point.threads);
      advance(simulation, scene.period_ticks());
      time_stretch(simulation, scene, ticks, point.speed);
      point.hash = simulation.state_hash();
      progress.show(++done / static_cast<double>(effort.repeat * static_cast<int>(threads.size())));
    }
  }
  return result;
}

}  // namespace shaken::bench
