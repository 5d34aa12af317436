#include <algorithm>
#include <cmath>

#include "analysis/order.h"
#include "base/failure.h"
#include "bench/hard/hard.h"
#include "sim/balance.h"
#include "sim/simulation.h"

namespace shaken::bench {

std::vector<HistoryPoint> history_of(const System& scene, double seconds, const OnProgress& on_progress) {
  // not a number that vibrations of 5, 50 or 100 ms would go into, so that samples see all phases of the plates
  constexpr int kSamples = 23;
  auto simulation = Simulation::start(scene);
  if (!simulation) throw Failure(ExitCode::kBadInput, simulation.error().message);
  const World& world = simulation->world();
  const double n = static_cast<double>(world.rods.size());
  const auto end = std::max<Tick>(1, std::llround(seconds / scene.dt));
  std::vector<HistoryPoint> history;
  for (Tick point = 1; point <= kHistoryPoints; ++point) {
    HistoryPoint mean;
    for (Tick sample = 1; sample <= kSamples; ++sample) {
      const Tick tick = end * ((point - 1) * kSamples + sample) / (Tick{kHistoryPoints} * kSamples);
      if (const auto trouble = simulation->advance_to(tick)) throw Failure(ExitCode::kFailed, to_text(*trouble));
      mean.order += analysis::nematic_order(simulation->snapshot().director).order / kSamples;
      mean.kinetic_energy += kinetic_energy(world).total() / (n * kSamples);
    }
    mean.time = simulation->time();
    mean.overlap = world.counters.max_overlap() / thinnest_radius(world);
    mean.energy_error = balance(world).energy_error();
    history.push_back(mean);
    on_progress(static_cast<double>(point) / kHistoryPoints);
  }
  return history;
}

}  // namespace shaken::bench
