// SPDX-License-Identifier: MIT
#include "bench/accuracy/order_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/order.h"
#include "analysis/time_series.h"
#include "base/clock.h"
#include "base/progress_line.h"
#include "bench/steady_state.h"

namespace shaken::bench {
namespace {

constexpr double kEvery = 0.005;  ///< between samples of S [s]; one vibration
constexpr int kFewest = 6;        ///< stretches that scatter is taken from

double average(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
  const double mean = average(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace

double OrderError::time_for(double sem) const { return 2 * tau * std::pow(c ? c->value / sem : std / sem, 2); }

double OrderError::replica_scatter() const {
  std::vector<double> means;
  for (const Mean& replica : replicas) means.push_back(replica.value);
  return means.size() < 2 ? 0 : deviation(means);
}

double OrderError::expected_scatter() const { return (c ? c->value : std) / std::sqrt(measured / (2 * tau)); }

OrderError reduce_order(const Case& scene, const std::vector<std::vector<double>>& series, double every) {
  OrderError of;
  of.scene = scene;
  of.measured = every * static_cast<double>(series.front().size());
  std::vector<double> all;
  for (const std::vector<double>& values : series) {
    of.replicas.push_back(mean_of(values));
    of.tau += every * (0.5 + analysis::autocorrelation_time(values)) / static_cast<double>(series.size());
    all.insert(all.end(), values.begin(), values.end());
  }
  of.mean = average(all);
  of.std = deviation(all);

  double weights = 0, weighted = 0;
  for (std::size_t length = 1;; length *= 2) {
    std::vector<double> means;
    for (const std::vector<double>& values : series) {
      for (std::size_t from = 0; from + length <= values.size(); from += length) {
        means.push_back(average({values.begin() + static_cast<std::ptrdiff_t>(from),
                                 values.begin() + static_cast<std::ptrdiff_t>(from + length)}));
      }
    }
    if (means.size() < kFewest) break;
    const double time = every * static_cast<double>(length);
    const double sem = deviation(means);
    const double sem_error = sem / std::sqrt(2 * (static_cast<double>(means.size()) - 1));
    of.errors.push_back({time, static_cast<int>(means.size()), sem, sem_error});
    if (time < OrderError::kLong * of.tau || sem == 0) continue;
    const double scale = std::sqrt(time / (2 * of.tau));
    const double weight = 1 / std::pow(sem_error * scale, 2);
    weights += weight;
    weighted += weight * sem * scale;
  }
  // the stretches of different lengths are of the same series: the best of them says how well c is known
  if (weights > 0) {
    double best = 1e300;
    for (const StretchError& error : of.errors) {
      if (error.time >= OrderError::kLong * of.tau)
        best = std::min(best, error.sem_error * std::sqrt(error.time / (2 * of.tau)));
    }
    of.c = Mean{weighted / weights, best};
  }
  return of;
}

OrderError measure_order_error(const Case& scene, double measure, int replicas, const std::filesystem::path& cache) {
  std::vector<std::vector<double>> series;
  double cpu = 0;
  for (int replica = 0; replica < replicas; ++replica) {
    Case start = scene;
    start.plan.system.seed = static_cast<std::uint64_t>(replica + 1);
    Simulation simulation = resumed(start, steady_state(start, cache), Engine::kScheduled);
    ProgressLine progress(fmt::format("S(t) of {}, seed {}", scene.label(), replica + 1));
    const Tick stride = std::llround(kEvery / scene.dt);
    const int samples = std::max(1, static_cast<int>(measure / kEvery));
    series.emplace_back();
    for (int k = 0; k < samples; ++k) {
      const double begun = cpu_seconds();
      advance(simulation, stride);
      cpu += cpu_seconds() - begun;
      series.back().push_back(analysis::nematic_order(simulation.snapshot().director).order);
      progress.show((k + 1.0) / samples);
    }
  }
  OrderError of = reduce_order(scene, series, kEvery);
  of.cpu_per_rod_second = cpu / (scene.system().n_rods * of.measured * replicas);
  return of;
}

double Extrapolation::time_for(double sem) const {
  const double std_there = std.coefficient * std::pow(side, std.order);
  return 2 * tau.coefficient * std::pow(side, tau.order) * std::pow(std_there / sem, 2);
}

std::optional<Extrapolation> extrapolate(const std::vector<OrderError>& measured, const Case& large) {
  std::vector<double> sides, stds, taus;
  for (const OrderError& of : measured) {
    sides.push_back(of.scene.side);
    stds.push_back(of.std);
    taus.push_back(of.tau);
  }
  const auto std_fit = fit_order(sides, stds, 0);
  const auto tau_fit = fit_order(sides, taus, 0);
  if (!std_fit || !tau_fit) return std::nullopt;
  return Extrapolation{*std_fit, *tau_fit, large.side, large.system().n_rods, measured.back().cpu_per_rod_second};
}

}  // namespace shaken::bench
