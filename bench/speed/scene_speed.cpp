// SPDX-License-Identifier: MIT
#include "bench/speed/scene_speed.h"

#include <algorithm>

#include "base/clock.h"
#include "base/progress_line.h"

namespace shaken::bench {

SceneSpeed measure_scene(const Case& scene, const SteadyState& state, const Effort& effort) {
  SceneSpeed speed;
  speed.scene = scene;
  speed.was_cached = state.was_cached;
  const Tick reference_ticks = ticks_for(effort.cpu, scene, state, Engine::kReference);
  const Tick scheduled_ticks = std::max(ticks_for(effort.cpu, scene, state, Engine::kScheduled), scene.period_ticks());
  // One tick builds the lists; from there on the reference is timed, and the scheduled engine settles.
  speed.compared_ticks = 1 + reference_ticks;
  const Tick settle = std::max<Tick>(0, scene.period_ticks() - speed.compared_ticks);

  ProgressLine progress("measuring " + scene.label());
  const double steps = 2.0 * effort.repeat + 2;
  double step = 0;
  const auto count = [&] { progress.show(++step / steps); };
  for (int repetition = 0; repetition < effort.repeat; ++repetition) {
    Simulation reference = resumed(scene, state, Engine::kReference);
    advance(reference, 1);
    time_stretch(reference, scene, reference_ticks, speed.reference);
    speed.reference_hash = reference.state_hash();
    count();
    Simulation scheduled = resumed(scene, state, Engine::kScheduled);
    advance(scheduled, speed.compared_ticks);
    speed.scheduled_hash = scheduled.state_hash();
    advance(scheduled, settle);
    time_stretch(scheduled, scene, scheduled_ticks, speed.scheduled);
    count();
    if (!speed.hashes_equal()) break;  // nothing is worth more measuring
  }

  Simulation timed = resumed(scene, state, Engine::kScheduled);
  advance(timed, speed.compared_ticks + settle);
  speed.bounds = measure_lower_bounds(timed.world());
  count();
  timed.time_phases(thread_cpu_seconds_without_readings);
  const double start = thread_cpu_seconds_without_readings();
  advance(timed, scheduled_ticks);
  speed.phases_cpu = thread_cpu_seconds_without_readings() - start;
  for (std::size_t p = 0; p < kPhases; ++p) speed.phases[p] = timed.phase_times().seconds(static_cast<Phase>(p));
  return speed;
}

}  // namespace shaken::bench
