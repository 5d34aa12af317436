#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include "analysis/order.h"
#include "base/failure.h"
#include "bench/hard/hard.h"
#include "bench/hard/same_mean.h"
#include "sim/balance.h"
#include "sim/simulation.h"

namespace shaken::bench {
namespace {

constexpr int kSettling = 11;  ///< one part in so many of a replica is not counted

struct Quantity {
  const char* name;
  /// The tolerance of a difference, as a fraction of the mean: four errors or more of that of two orders at the effort
  /// that is the default, so that means that are the same are nearly always shown to be.
  double bound;
};
constexpr std::size_t kQuantities = 6;
constexpr std::array<Quantity, kQuantities> kAll{{{"S", 0.025},
                                                  {"energy in the plane", 0.01},
                                                  {"energy across", 0.01},
                                                  {"impulses", 0.02},
                                                  {"tilt", 0.005},
                                                  {"drift along the tilted rod", 0.15}}};
using Means = std::array<double, kQuantities>;

/// Means of one replica over time.
std::variant<Means, NumericalTrouble> means_of(const System& scene, double seconds) {
  auto simulation = Simulation::start(scene);
  if (!simulation) throw Failure(ExitCode::kBadInput, simulation.error().message);
  const World& world = simulation->world();
  const auto end = static_cast<Tick>(std::llround(seconds / scene.dt));
  const Tick stride = std::max<Tick>(1, std::llround(kSampleEvery / scene.dt));
  if (auto trouble = simulation->advance_to(end / kSettling)) return *trouble;
  const std::int64_t impulses_before = world.counters.impulses_rod_rod;
  Means sum{};
  int n_samples = 0;
  while (simulation->tick() < end) {
    if (auto trouble = simulation->advance_to(std::min(end, simulation->tick() + stride))) return *trouble;
    const KineticEnergy energy = kinetic_energy(world);
    sum[1] += energy.translation_xy;
    sum[2] += energy.translation_z;
    const Snapshot snapshot = simulation->snapshot();
    const auto n = static_cast<double>(snapshot.n_rods());
    for (std::size_t i = 0; i < snapshot.n_rods(); ++i) {
      const Vec3& director = snapshot.director[i];
      const Vec3& velocity = snapshot.velocity[i];
      sum[4] += std::abs(director.z()) / n;
      sum[5] += std::copysign(1.0, director.z()) * (velocity.x() * director.x() + velocity.y() * director.y()) / n;
    }
    sum[0] += analysis::nematic_order(snapshot.director).order;
    ++n_samples;
  }
  for (double& s : sum) s /= n_samples;
  sum[3] = static_cast<double>(world.counters.impulses_rod_rod - impulses_before);
  return sum;
}

/// The outcome of the two orders that are farthest from being the same.
Outcome outcome_of(const Quantity& quantity, const std::array<std::vector<double>, 3>& samples,
                   const OrderEffort& effort) {
  const double bound = quantity.bound * effort.slack;
  Outcome outcome{fmt::format("{}: difference / mean, 95 % sure", quantity.name), 0, bound};
  for (const auto& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
    const Apart apart = compare_means(samples[a], samples[b]);
    if (apart.farthest() <= outcome.worst) continue;
    outcome.worst = apart.farthest();  // NaN if there are too few replicas, which nothing exceeds and which never holds
    const Sameness sameness = apart.within(bound);
    outcome.note = fmt::format("{:.2g} +- {:.2g} % apart{}", 100 * apart.difference, 100 * apart.half_width,
                               sameness == Sameness::kSame        ? ""
                               : sameness == Sameness::kDifferent ? ": different"
                                                                  : ": open, more or longer replicas are needed");
    if (std::isnan(outcome.worst)) break;
  }
  return outcome;
}

}  // namespace

HardCase run_order_case(const std::filesystem::path& folder, const OrderEffort& effort, const OnProgress& on_progress) {
  HardCase result{kOrderCase, "contacts of a tick sorted, reversed, shuffled: the same statistics", {}};
  std::array<std::array<std::vector<double>, 3>, kQuantities> samples;
  std::size_t k = 0;
  for (const char* name : {"order-sorted", "order-reversed", "order-shuffled"}) {
    const scene::RunPlan plan = read_hard_scene(folder, name);
    for (int replica = 0; replica < effort.replicas; ++replica) {
      System scene = plan.system;
      scene.seed += static_cast<std::uint64_t>(replica);
      const auto means = means_of(scene, std::min(effort.seconds, plan.total_time()));
      if (const auto* trouble = std::get_if<NumericalTrouble>(&means)) {
        result.outcomes.push_back({"no numerical trouble", 1, 0, false, to_text(*trouble)});
        return result;
      }
      for (std::size_t q = 0; q < kQuantities; ++q) samples[q][k].push_back(std::get<Means>(means)[q]);
      on_progress((static_cast<double>(k) + (replica + 1.0) / effort.replicas) / 3);
    }
    ++k;
  }
  for (std::size_t q = 0; q < kQuantities; ++q) {
    result.outcomes.push_back(outcome_of(kAll[q], samples[q], effort));
  }
  return result;
}

}  // namespace shaken::bench
