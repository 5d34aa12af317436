// The nematic order of 120 shaken rods against time, with Shaken's libraries.
#include <cstdio>

#include "analysis/order.h"
#include "sim/simulation.h"

int main() {
  shaken::System scene;  // the paper's plates and contacts
  scene.rod.length = 4.5;
  scene.n_rods = 120;
  scene.box_side = 20;

  auto started = shaken::Simulation::start(scene);
  if (!started) {
    std::fprintf(stderr, "%s\n", started.error().message.c_str());
    return 2;
  }
  shaken::Simulation& simulation = *started;
  const shaken::Tick ticks_per_sample = 2500;  // 10 ms
  for (int sample = 0; sample <= 20; ++sample) {
    if (const auto trouble = simulation.advance_to(sample * ticks_per_sample)) {
      std::fprintf(stderr, "tick %lld: %s\n", static_cast<long long>(trouble->tick), trouble->what.c_str());
      return 1;
    }
    const auto order = shaken::analysis::nematic_order(simulation.snapshot().director);
    std::printf("%.3f s  S = %.4f\n", simulation.time(), order.order);
  }
  return 0;
}
