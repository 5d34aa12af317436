// SPDX-License-Identifier: MIT
#include "bench/accuracy/order_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "analysis/order.h"
#include "analysis/time_series.h"
#include "base/clock.h"
#include "base/progress_line.h"
#include "base/text.h"
#include "bench/accuracy/observables.h"

namespace shaken::bench {
namespace {

constexpr double kEvery = 0.005;  ///< between samples of S [s]; one vibration
constexpr int kFewest = 6;        ///< stretches that scatter is taken from

/// Standard deviation of one of the samples.
double deviation(const std::vector<double>& samples) {
  return mean_of_samples(samples).sem * std::sqrt(static_cast<double>(samples.size()));
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
  of.mean = mean_of_samples(all).value;
  of.std = deviation(all);

  double weights = 0, weighted = 0, best = std::numeric_limits<double>::infinity();
  for (std::size_t length = 1;; length *= 2) {
    std::vector<double> means;
    for (const std::vector<double>& values : series) {
      for (std::size_t from = 0; from + length <= values.size(); from += length) {
        means.push_back(mean_of_samples(std::span(values).subspan(from, length)).value);
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
    best = std::min(best, sem_error * scale);
  }
  // the stretches of different lengths are of the same series: the best of them says how well c is known
  if (weights > 0) of.c = Mean{weighted / weights, best};
  return of;
}

OrderError measure_order_error(const Case& scene, double measure, int replicas, const Cache& cache) {
  std::vector<std::vector<double>> series;
  double cpu = 0;
  for (int replica = 0; replica < replicas; ++replica) {
    Case start = scene;
    start.plan.system.seed = static_cast<std::uint64_t>(replica + 1);
    Simulation simulation = resumed(start, cache(start), Engine::kScheduled);
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

namespace {

constexpr std::array<double, 3> kWanted{0.01, 0.001, 0.0001};  ///< errors of S whose cost is told

Json order_error_row(const OrderError& of) {
  Json row{{"side_mm", of.scene.side},
           {"n_rods", of.scene.system().n_rods},
           {"replicas", of.replicas.size()},
           {"measured_s", of.measured},
           {"mean", of.mean},
           {"std", of.std},
           {"tau_s", of.tau},
           {"measured_over_tau", of.measured / of.tau}};
  row["c"] = of.c ? Json(of.c->value) : Json(nullptr);
  row["c_error"] = of.c ? Json(of.c->sem) : Json(nullptr);
  row["c_over_std"] = of.c ? Json(of.c->value / of.std) : Json(nullptr);
  row["replica_scatter"] = of.replicas.size() > 1 ? Json(of.replica_scatter()) : Json(nullptr);
  row["expected_scatter"] = of.expected_scatter();
  row["cpu_s_per_rod_s"] = of.cpu_per_rod_second;
  for (const double sem : kWanted) row["cpu_s_for_sem"][fmt::format("{:g}", sem)] = of.cpu_for(sem);
  row["stretch_s"] = row["sem"] = row["sem_error"] = Json::array();
  for (const StretchError& error : of.errors) {
    row["stretch_s"].push_back(error.time);
    row["sem"].push_back(error.sem);
    row["sem_error"].push_back(error.sem_error);
  }
  return row;
}

std::string extrapolated_text(const Extrapolation& large) {
  std::string text = fmt::format(
      "\nExtrapolated to L = {:.10g} mm, N = {}: std ~ L^{:.2f} (+- {:.2f}), tau ~ L^{:.2f} (+- {:.2f}), {:.3g} CPU-s "
      "per rod-s\nas in the largest box measured. Power laws carried this far are no measurement.\n",
      large.side, large.n_rods, large.std.order, large.std.order_error, large.tau.order, large.tau.order_error,
      large.cpu_per_rod_second);
  for (const double sem : kWanted) {
    text += fmt::format("  sem(S) = {:g}: {} simulated, {:.3g} CPU-hours\n", sem, duration_text(large.time_for(sem)),
                        large.cpu_for(sem) / 3600);
  }
  return text +
         "Replicas share that time between cores; each adds its way to the steady state. One more digit costs 100 "
         "times as much.\n";
}

}  // namespace

Report order_error_report(const std::vector<OrderError>& measured, const std::optional<Extrapolation>& large) {
  Report report("error", "accuracy error");
  for (const OrderError& of : measured) report.json["rows"].push_back(order_error_row(of));
  report.json["extrapolated"] = nullptr;
  if (large) {
    report.json["extrapolated"] = {{"side_mm", large->side},
                                   {"n_rods", large->n_rods},
                                   {"std_power", large->std.order},
                                   {"std_power_error", large->std.order_error},
                                   {"tau_power", large->tau.order},
                                   {"tau_power_error", large->tau.order_error},
                                   {"cpu_s_for_sem_0.001", large->cpu_for(0.001)}};
  }
  std::vector<Column> columns{{"L mm", "side_mm", "{:.10g}"},
                              {"N", "n_rods"},
                              {"replicas", "replicas"},
                              {"T s", "measured_s", "{:.4g}"},
                              {"T/tau", "measured_over_tau", "{:.0f}"},
                              {"S", "mean", "{:.4f}"},
                              {"std", "std", "{:.4f}"},
                              {"tau s", "tau_s", "{:.3g}"},
                              {"c", "c", "{:.4f} +- {:.4f}", 1, "c_error"},
                              {"c/std", "c_over_std", "{:.2f}"},
                              {"scatter", "replica_scatter", "{:.4f}"},
                              {"expected", "expected_scatter", "{:.4f}"},
                              {"CPU-s/rod-s", "cpu_s_per_rod_s", "{:.3g}"}};
  for (const double sem : kWanted) {
    const std::string name = fmt::format("{:g}", sem);
    columns.push_back({(sem == kWanted[0] ? "CPU-s for " : "") + name, "cpu_s_for_sem/" + name, "{:.3g}"});
  }
  report.text +=
      "\nStatistical error of S over a simulated time T: sem = c / sqrt(T / 2 tau). tau: integrated autocorrelation\n"
      "time of S(t); c: from the scatter of means over stretches of at least 5 tau, to be compared with std, the "
      "spread\nof S(t). Scatter: of the replicas' means, measured and by that formula.\n" +
      table(report.rows(), columns) + "T/tau below 100: tau, and all that follows from it, is rough.\n" +
      (large ? extrapolated_text(*large) : "Too few boxes, or no power law: nothing is said of larger ones.\n");
  return report;
}

}  // namespace shaken::bench
