// SPDX-License-Identifier: MIT
#include "bench/hard/scene_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>

#include "bench/failure.h"
#include "scene/load.h"
#include "sim/balance.h"
#include "sim/simulation.h"

namespace shaken::bench {
namespace {

constexpr double kLookEvery = 2e-3;  ///< [s]
/// Standard deviation of the speed at the start, three components (sim/initial.cpp) [mm/s].
constexpr double kStartSpeed = 20.0 * 1.7320508;
/// The books must close to this, as a fraction of all that changed hands; and to a rounding for each impulse.
constexpr double kLedgerLimit = 1e-12;
constexpr double kLedgerPerImpulse = 1e-16;

/// What is seen of a run.
struct Seen {
  std::optional<NumericalTrouble> trouble;
  double most_energy = 0;       ///< kinetic, per rod [pJ]
  double growth = -1;           ///< largest rise of the total energy between two looks, of that at the start
  double drift = 0;             ///< largest change of the total energy, of that at the start
  double longest_director = 0;  ///< | |n| - 1 |
  double late_bouncing = 0;     ///< largest kinetic energy of vertical motion per rod after a tenth of the time [pJ]
  double tenth_energy = 0;      ///< kinetic, after a tenth of the time [pJ]
  double late_energy = 0;       ///< largest of that later [pJ]
};

double total_energy(const World& world) { return content(world).energy; }

Seen watch_run(Simulation& simulation, double seconds, const Watch& watch) {
  Seen seen;
  const World& world = simulation.world();
  const auto n = static_cast<double>(world.rods.size());
  const auto end = static_cast<Tick>(std::llround(seconds / world.scene.dt));
  const Tick stride = std::max<Tick>(1, std::llround(kLookEvery / world.scene.dt));
  const double start = total_energy(world);
  double before = start;
  while (simulation.tick() < end) {
    seen.trouble = simulation.advance_to(std::min(end, simulation.tick() + stride));
    if (seen.trouble) return seen;
    const double kinetic = kinetic_energy(world).total() / n;
    seen.most_energy = std::max(seen.most_energy, kinetic);
    const double now = total_energy(world);
    seen.growth = std::max(seen.growth, (now - before) / start);
    seen.drift = std::max(seen.drift, std::abs(now - start) / start);
    before = now;
    for (const Vec3& director : simulation.snapshot().director) {
      seen.longest_director = std::max(seen.longest_director, std::abs(director.norm() - 1));
    }
    if (10 * simulation.tick() >= end) {
      if (seen.tenth_energy == 0) seen.tenth_energy = kinetic;
      seen.late_energy = std::max(seen.late_energy, kinetic);
      seen.late_bouncing = std::max(seen.late_bouncing, kinetic_energy(world).translation_z / n);
    }
    watch(static_cast<double>(simulation.tick()) / static_cast<double>(end));
  }
  return seen;
}

double thinnest_radius(const World& world) {
  double radius = std::numeric_limits<double>::infinity();
  for (const Species& species : world.species) {
    radius = std::min(radius, *std::min_element(species.bead_radius.begin(), species.bead_radius.end()));
  }
  return radius;
}

/// Energy that a rod cannot exceed on average, with a body hit by both plates again and again as the worst case: it
/// leaves a plate at (1 + e) / (1 - e) of the plate's speed, and falls through the gap.
double energy_limit(const World& world) {
  const Scene& scene = world.scene;
  const double e = std::max(scene.rod_base.restitution, scene.rod_lid.restitution);
  const double speed =
      (1 + e) / (1 - e) * world.plates.peak_speed() + std::sqrt(2 * scene.gravity * scene.gap) + kStartSpeed;
  return 0.5 * world.species.front().mass * speed * speed;
}

std::string text_of(const NumericalTrouble& trouble) {
  return fmt::format("tick {}, rods {}: {}", trouble.tick, fmt::join(trouble.rods, ", "), trouble.what);
}

}  // namespace

const std::vector<SceneCase>& scene_cases() {
  static const std::vector<SceneCase> cases{
      {"packed", "packed to 0.90 and started there"},
      {"crystal", "aligned rods in a gap of 0.9 mm"},
      {"narrow", "a gap of 0.82 mm: rods nearly touch both plates"},
      {"tall", "a gap of 6 mm: rods stand upright and tumble"},
      {"inelastic", "e = 0"},
      {"collapse", "e = 0.05: inelastic collapse"},
      {"elastic", "e = 1, no friction, plates at rest: nothing is lost"},
      {"friction-0-newton", "no friction"},
      {"friction-0-energetic", "no friction, energetic law"},
      {"friction-1-newton", "mu = 1"},
      {"friction-1-energetic", "mu = 1, energetic law"},
      {"friction-1000-newton", "mu = 1000"},
      {"friction-1000-energetic", "mu = 1000, energetic law"},
      {"elastic-rough-energetic", "e = 1, mu = 1, plates at rest, energetic law"},
      {"elastic-rough-poisson", "e = 1, mu = 1, plates at rest, Poisson's law"},
      {"elastic-rough-newton", "e = 1, mu = 1, plates at rest, Newton's law", 0.1, true},
      {"spheres", "one bead"},
      {"three-beads", "three beads"},
      {"no-taper", "no taper"},
      {"needle", "aspect ratio 50"},
      {"dumbbell", "wider at the ends"},
      {"strong", "Gamma = 30"},
      {"wild", "Gamma = 100"},
      {"coarse", "a tick ten times too long", 0.5},
      {"rest", "Gamma = 0: all comes to rest"},
  };
  return cases;
}

scene::RunPlan read_hard_scene(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = folder / (name + ".json");
  std::ifstream in(file);
  if (!in) {
    throw Failure(
        ExitCode::kBadInput,
        fmt::format("cannot read {}; --cases DIR names the folder configs/hard of the sources", file.string()));
  }
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const scene::Loaded<scene::RunPlan> plan = scene::load_scene(text, file.string());
  if (!plan.value) throw Failure(ExitCode::kBadInput, to_string(plan.problems));
  return *plan.value;
}

HardCase run_scene_case(const SceneCase& wanted, const scene::RunPlan& plan, double seconds, const Watch& watch) {
  HardCase result{wanted.name, wanted.what, {}};
  auto simulation = Simulation::start(plan.system);
  if (!simulation) {
    result.outcomes.push_back({"the rods can be placed", 1, 0, false, simulation.error().message});
    return result;
  }
  const double duration = std::min(seconds, plan.total_time());
  const Seen seen = watch_run(*simulation, duration, watch);
  const World& world = simulation->world();
  if (seen.trouble) {
    result.outcomes.push_back({"no numerical trouble", 1, 0, false, text_of(*seen.trouble)});
    return result;
  }
  result.outcomes.push_back(
      {"overlap / thinnest bead's radius", world.counters.max_overlap() / thinnest_radius(world), wanted.max_overlap});
  const bool shaken = world.scene.amplitude > 0;
  if (shaken) {
    result.outcomes.push_back({"kinetic energy per rod [pJ]", seen.most_energy, energy_limit(world)});
  } else if (wanted.makes_energy) {
    result.outcomes.push_back({"energy made in 2 ms / energy", seen.growth, 1e-4, true, "by this law, as is known"});
  } else {
    const bool elastic = world.scene.rod_base.restitution == 1;
    result.outcomes.push_back(
        {"energy made in 2 ms / energy", std::max(0.0, seen.growth), elastic ? kRounding : kRest});
  }
  if (wanted.name == "elastic") {
    result.outcomes.push_back({"change of energy / energy", seen.drift, kRounding});
  }
  if (wanted.name == "rest") {
    // A tick of free fall, ended by the base, is all the bouncing there should be. What rolls goes on rolling: nothing
    // in the model stops it, but nothing drives it either.
    const double tick_fall = world.scene.gravity * world.scene.dt;
    result.outcomes.push_back({"bouncing energy per rod after a tenth [pJ]", seen.late_bouncing,
                               world.species.front().mass * tick_fall * tick_fall});
    result.outcomes.push_back(
        {"rise of kinetic energy after a tenth / energy", seen.late_energy / seen.tenth_energy - 1, 0.01});
  }
  const Counters& counters = world.counters;
  const auto n_impulses =
      static_cast<double>(counters.impulses_rod_rod + counters.impulses_rod_base + counters.impulses_rod_lid);
  result.outcomes.push_back({"energy unaccounted for / turnover", balance(world).energy_error(),
                             std::max(kLedgerLimit, kLedgerPerImpulse * n_impulses)});
  result.outcomes.push_back({"length of a director, off 1 by", seen.longest_director, 1e-14});
  return result;
}

HardCase run_order_case(const std::filesystem::path& folder, double seconds, const Watch& watch) {
  HardCase result{kOrderCase, "contacts of a tick sorted, reversed, shuffled: the same statistics", {}};
  constexpr int kBlocks = 12;
  // all of them settle within milliseconds; S takes minutes
  constexpr int kQuantities = 5;
  constexpr std::array<const char*, kQuantities> kNames{"energy in the plane", "energy across", "impulses", "tilt",
                                                        "drift along the tilted rod"};
  struct Estimate {
    double mean = 0, error2 = 0;
  };
  std::array<std::array<Estimate, kQuantities>, 3> found;
  int k = 0;
  for (const char* name : {"order-sorted", "order-reversed", "order-shuffled"}) {
    const scene::RunPlan plan = read_hard_scene(folder, name);
    auto simulation = Simulation::start(plan.system);
    if (!simulation) throw Failure(ExitCode::kBadInput, simulation.error().message);
    const World& world = simulation->world();
    const double duration = std::min(seconds, plan.total_time());
    const auto block_ticks = static_cast<Tick>(duration / plan.system.dt / (kBlocks + 2));
    const Tick stride = std::max<Tick>(1, std::llround(kLookEvery / plan.system.dt));
    std::array<std::vector<double>, kQuantities> blocks;
    for (int block = -2; block < kBlocks; ++block) {  // the first two are not counted
      std::array<double, kQuantities> sum{};
      int n_looks = 0;
      const std::int64_t impulses = world.counters.impulses_rod_rod;
      const Tick block_end = simulation->tick() + block_ticks;
      while (simulation->tick() < block_end) {
        if (const auto trouble = simulation->advance_to(std::min(block_end, simulation->tick() + stride))) {
          result.outcomes.push_back({"no numerical trouble", 1, 0, false, text_of(*trouble)});
          return result;
        }
        const KineticEnergy energy = kinetic_energy(world);
        sum[0] += energy.translation_xy;
        sum[1] += energy.translation_z;
        const Snapshot snapshot = simulation->snapshot();
        const auto n = static_cast<double>(snapshot.director.size());
        for (std::size_t i = 0; i < snapshot.director.size(); ++i) {
          const Vec3& director = snapshot.director[i];
          const Vec3& velocity = snapshot.velocity[i];
          sum[3] += std::abs(director.z()) / n;
          sum[4] += std::copysign(1.0, director.z()) * (velocity.x() * director.x() + velocity.y() * director.y()) / n;
        }
        ++n_looks;
      }
      watch((k + (block + 3.0) / (kBlocks + 2)) / 3);
      if (block < 0) continue;
      for (double& s : sum) s /= n_looks;
      sum[2] = static_cast<double>(world.counters.impulses_rod_rod - impulses);
      for (int q = 0; q < kQuantities; ++q) blocks[q].push_back(sum[q]);
    }
    for (int q = 0; q < kQuantities; ++q) {
      Estimate& estimate = found[k][q];
      for (const double value : blocks[q]) estimate.mean += value / kBlocks;
      for (const double value : blocks[q]) {
        estimate.error2 += (value - estimate.mean) * (value - estimate.mean) / (kBlocks * (kBlocks - 1.0));
      }
    }
    ++k;
  }
  for (int q = 0; q < kQuantities; ++q) {
    double worst = 0;
    double difference = 0;
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
      const double apart = std::abs(found[a][q].mean - found[b][q].mean);
      worst = std::max(worst, apart / std::sqrt(found[a][q].error2 + found[b][q].error2));
      difference = std::max(difference, std::abs(apart / found[0][q].mean));
    }
    result.outcomes.push_back({fmt::format("{}: difference / standard error", kNames[q]), worst, 4, false,
                               fmt::format("{:.2g} % apart", 100 * difference)});
  }
  return result;
}

}  // namespace shaken::bench
