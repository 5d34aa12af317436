#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sim/simulation.h"
#include "sim/start/initial.h"

/// Whether two ways of stepping the same scene give the same, to the last bit: states, counters and ledgers.
namespace shaken::test {

inline bool same(const Counters& a, const Counters& b) {
  const auto all = [](const Counters& c) {
    std::vector<double> values;
    std::apply([&](auto... field) { (values.push_back(static_cast<double>(c.*field)), ...); }, Counters::fields());
    const Ledger& ledger = c.ledger;
    for (const auto* sum : {&ledger.lost_rod_rod, &ledger.lost_surfaces, &ledger.given, &ledger.noise})
      values.push_back(sum->value());
    for (const auto& sum : ledger.momentum) values.push_back(sum.value());
    for (const auto& sum : ledger.virial) values.push_back(sum.value());
    return values;
  };
  return all(a) == all(b);
}

/// What came of a comparison.
struct Compared {
  std::string difference{};  ///< empty: there was none
  bool in_full = false;      ///< both went through at least half of the ticks asked for
  bool fits = true;          ///< the rods could be placed; otherwise nothing was compared
};

/// What differed, or why too little was compared; empty if all is well.
inline std::string problem(const Compared& compared) {
  if (!compared.difference.empty()) return compared.difference;
  if (!compared.fits) return "the rods cannot be placed";
  return compared.in_full ? "" : "both meet trouble before half of the ticks";
}

/// Steps on 2 and 4 threads, shared as finely as can be, give the same as on one. Not for long: threads wait for each
/// other in every tick.
inline Compared compare_threads(const System& system, Tick ticks) {
  auto one = Simulation::start(system);
  if (!one) return {.fits = false};
  const auto trouble = one->advance_to(ticks);
  for (const int n_threads : {2, 4}) {
    auto several = Simulation::start(system);
    several->use_threads(n_threads, 1);
    const auto its = several->advance_to(ticks);
    const std::string where = " on " + std::to_string(n_threads) + " threads";
    if (trouble.has_value() != its.has_value() || (trouble && trouble->rods != its->rods))
      return {"other trouble" + where};
    if (one->tick() != several->tick() || one->state_hash() != several->state_hash()) return {"states differ" + where};
    if (!trouble && !same(one->world().counters, several->world().counters)) return {"counters differ" + where};
  }
  return {"", one->tick() >= ticks / 2};
}

/// Steps both from the same world, compares the hashes at several ticks, and once more after a checkpoint and restart
/// at tick `stop`; ticks are counted from where the world is.
inline Compared compare(World world, Tick ticks, Tick stop) {
  const Tick begin = world.tick;
  world.system.stepper = StepperKind::kReference;
  Simulation reference = Simulation::start_from(world);
  world.system.stepper = StepperKind::kScheduled;
  const System system = world.system;
  Simulation scheduled = Simulation::start_from(std::move(world));
  std::vector<Tick> looks{1, 2, stop, ticks / 2, ticks};
  std::sort(looks.begin(), looks.end());
  for (const Tick k : looks) {
    const auto trouble_r = reference.advance_to(begin + k);
    const auto trouble_s = scheduled.advance_to(begin + k);
    const std::string when = " at tick " + std::to_string(k);
    if (trouble_r.has_value() != trouble_s.has_value()) return {"only one of them met trouble by then" + when};
    if (trouble_r && (trouble_r->tick != trouble_s->tick || trouble_r->rods != trouble_s->rods))
      return {"different trouble"};
    if (reference.state_hash() != scheduled.state_hash()) return {"states differ" + when};
    if (trouble_r) return {"", trouble_r->tick - begin >= ticks / 2};
    if (!same(reference.world().counters, scheduled.world().counters)) return {"counters differ" + when};
    if (k == stop) {
      auto resumed = Simulation::resume(system, scheduled.checkpoint());
      if (!resumed) return {resumed.error().message};
      scheduled = std::move(resumed).value();
    }
  }
  return {"", true};
}

/// The same from the scene's start.
inline Compared compare(const System& system, Tick ticks, Tick stop) {
  auto world = make_world(system);
  if (!world) return {.fits = false};
  return compare(std::move(world).value(), ticks, stop);
}

}  // namespace shaken::test
