// SPDX-License-Identifier: MIT
#include "bench/accuracy/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/parts.h"
#include "base/clock.h"
#include "base/progress_line.h"
#include "bench/steady_state.h"
#include "sim/rod/species.h"

namespace shaken::bench {
namespace {

/// The scene that the rods of one value start from, with its own steady state.
Case start_of(const StatisticsTask& task, double value, int replica) {
  Case start = task.scene;
  Scene& scene = start.plan.system;
  scene.seed = static_cast<std::uint64_t>(replica + 1);
  if (task.knob == Knob::kPitch) {
    scene.rod.n_beads = beads_for_pitch(scene.rod.length, scene.rod.end_diameter, value);
  }
  return start;
}

Scene scene_of(const StatisticsTask& task, const Case& start, double value) {
  Scene scene = start.system();
  task.variant->apply(scene);
  if (task.knob == Knob::kStep) scene.dt = 1e-6 * value;
  if (task.knob == Knob::kSweeps) scene.solver_sweeps = static_cast<int>(value);
  return scene;
}

/// Values of one replica.
struct Replica {
  std::array<Mean, kObservables> means;
  double cpu = 0;
};

Replica run(const StatisticsTask& task, double value, int replica, const std::filesystem::path& cache,
            ObservableSeries& series, double& max_overlap) {
  const Case start = start_of(task, value, replica);
  const SteadyState state = steady_state(start, cache);
  Simulation simulation = continued(resumed(start, state, Engine::kScheduled), scene_of(task, start, value));
  const double dt = simulation.world().scene.dt;
  ProgressLine progress(fmt::format("{}, {} {:.10g}, seed {}", start.label(), kKnobNames[static_cast<int>(task.knob)],
                                    value, replica + 1));
  advance(simulation, std::llround(task.settle / dt));
  const Tick stride = std::llround(ObservableSeries::kEvery / dt);
  const int samples = std::max(1, static_cast<int>(task.measure / ObservableSeries::kEvery));
  Replica result;
  for (int k = 0; k < samples; ++k) {
    const double begun = cpu_seconds();
    advance(simulation, stride);
    result.cpu += cpu_seconds() - begun;
    series.sample(simulation);
    progress.show((k + 1.0) / samples);
  }
  for (int o = 0; o < kObservables; ++o) result.means[o] = mean_of(series.values(static_cast<Observable>(o)));
  max_overlap = std::max(max_overlap, simulation.world().counters.max_overlap());
  return result;
}

}  // namespace

Simulation continued(const Simulation& from, const Scene& scene) {
  const Snapshot rods = from.snapshot();
  World world = empty_world(scene);
  world.tick = std::llround(from.time() / scene.dt);
  for (std::size_t i = 0; i < rods.n_rods(); ++i) {
    Flight flight;
    flight.image = rods.image[i];
    begin_flight(flight, world.tick, {rods.position[i], rods.director[i]}, {rods.velocity[i], rods.angular_velocity[i]},
                 scene.box_side, world.species[0].inertia_par / world.species[0].inertia_perp);
    world.rods.push_back(flight);
  }
  return Simulation::start_from(std::move(world));
}

Statistics measure_statistics(const StatisticsTask& task, const std::filesystem::path& cache) {
  Statistics statistics{task, {}, {}};
  for (const double value : task.values) {
    StatisticsPoint point;
    point.value = value;
    std::array<std::vector<Mean>, kObservables> replicas;
    std::optional<analysis::TiltVelocity> no_tilt;
    std::vector<analysis::TiltVelocity> tilt;
    double cpu = 0;
    for (int replica = 0; replica < task.replicas; ++replica) {
      ObservableSeries series;
      const Replica result = run(task, value, replica, cache, series, point.max_overlap);
      for (int o = 0; o < kObservables; ++o) replicas[o].push_back(result.means[o]);
      cpu += result.cpu;
      no_tilt = series.tilt().empty();
      for (analysis::TiltVelocity& part : series.tilt().parts_after(0.0, analysis::kMostParts)) {
        tilt.push_back(std::move(part));
      }
    }
    for (int o = 0; o < kObservables; ++o) point.means[o] = mean_of(replicas[o]);
    point.tilt = analysis::TiltVelocity::reduce(*no_tilt, tilt);
    point.cpu_per_rod_second = cpu / (task.scene.system().n_rods * task.measure * task.replicas);
    statistics.points.push_back(std::move(point));
  }

  for (int o = 0; o < kObservables; ++o) {
    Mean truth = statistics.points.front().means[o];
    std::vector<double> x;
    std::vector<Mean> means;
    for (const StatisticsPoint& point : statistics.points) {
      if (point.value > statistics.limit_step() || !(point.means[o].sem > 0)) continue;
      x.push_back(point.value);
      means.push_back(point.means[o]);
    }
    if (task.knob == Knob::kStep && kObservableInfo[o].has_limit && x.size() >= 2) {
      statistics.limits[o] = limit_of(x, means);
      truth = statistics.limits[o]->at_zero;
    }
    for (StatisticsPoint& point : statistics.points) point.biases[o] = relative_bias(point.means[o], truth);
    // the first value against itself is no measurement
    if (!statistics.limits[o]) statistics.points.front().biases[o] = {0, 0};
  }
  return statistics;
}

}  // namespace shaken::bench
