// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "analysis/order.h"
#include "analysis/time_series.h"
#include "base/text.h"
#include "bench/accuracy/accuracy.h"
#include "bench/fits.h"
#include "bench/timing.h"

namespace shaken::bench {
namespace {

constexpr double kEvery = 0.005;                               ///< between samples of S [s]; one vibration
constexpr std::size_t kFewest = 6;                             ///< stretches that scatter is taken from
constexpr double kLong = 5;                                    ///< length of stretches that c is taken from, in tau
constexpr std::array<double, 3> kWanted{0.01, 0.001, 0.0001};  ///< errors of S whose cost is told

/// Standard deviation of one of the samples.
double deviation(const std::vector<double>& samples) {
  return mean_of_samples(samples).sem * std::sqrt(static_cast<double>(samples.size()));
}

/// Simulated time until the error of S is `sem` [s].
double time_for(double sem, double c, double tau) { return 2 * tau * std::pow(c / sem, 2); }

/// Means of S over all stretches of `length` samples.
std::vector<double> stretch_means(const std::vector<std::vector<double>>& series, std::size_t length) {
  std::vector<double> means;
  for (const std::vector<double>& values : series) {
    for (std::size_t from = 0; from + length <= values.size(); from += length) {
      means.push_back(mean_of_samples(std::span(values).subspan(from, length)).value);
    }
  }
  return means;
}

}  // namespace

Json reduce_order(const Case& scene, const std::vector<std::vector<double>>& series, double every,
                  double cpu_per_rod_second) {
  const double measured = every * static_cast<double>(series.front().size());
  double tau = 0;
  std::vector<double> all, replicas;
  for (const std::vector<double>& values : series) {
    replicas.push_back(mean_of_samples(values).value);
    tau += every * (0.5 + analysis::autocorrelation_time(values)) / static_cast<double>(series.size());
    all.insert(all.end(), values.begin(), values.end());
  }
  const double std = deviation(all);

  Json stretches = Json::array(), sems = Json::array(), sem_errors = Json::array();
  double weights = 0, weighted = 0, best = std::numeric_limits<double>::infinity();
  for (std::size_t length = 1;; length *= 2) {
    const std::vector<double> means = stretch_means(series, length);
    if (means.size() < kFewest) break;
    const double time = every * static_cast<double>(length);
    const double sem = deviation(means);
    const double sem_error = sem / std::sqrt(2 * (static_cast<double>(means.size()) - 1));
    stretches.push_back(time);
    sems.push_back(sem);
    sem_errors.push_back(sem_error);
    if (time < kLong * tau || sem == 0) continue;
    const double scale = std::sqrt(time / (2 * tau));
    const double weight = 1 / std::pow(sem_error * scale, 2);
    weights += weight;
    weighted += weight * sem * scale;
    best = std::min(best, sem_error * scale);
  }
  const double c = weights > 0 ? weighted / weights : std;
  Json row{{"side_mm", scene.side},
           {"n_rods", scene.system().n_rods},
           {"replicas", replicas.size()},
           {"measured_s", measured},
           {"mean", mean_of_samples(all).value},
           {"std", std},
           {"tau_s", tau},
           {"measured_over_tau", measured / tau},
           {"c", nullptr},
           {"c_error", nullptr},
           {"c_over_std", nullptr}};
  // the stretches of different lengths are of the same series: the best of them says how well c is known
  if (weights > 0) row.update({{"c", c}, {"c_error", best}, {"c_over_std", c / std}});
  row["replica_scatter"] = replicas.size() > 1 ? Json(deviation(replicas)) : Json(nullptr);
  row["expected_scatter"] = c / std::sqrt(measured / (2 * tau));
  row["cpu_s_per_rod_s"] = cpu_per_rod_second;
  for (const double sem : kWanted) {
    row["cpu_s_for_sem"][fmt::format("{:g}", sem)] = time_for(sem, c, tau) * scene.system().n_rods * cpu_per_rod_second;
  }
  row.update({{"sem_error", sem_errors}, {"sem", sems}, {"stretch_s", stretches}});
  return row;
}

Json measure_order_error(const Case& scene, double measure, int replicas, const Cache& cache) {
  std::vector<std::vector<double>> series;
  double cpu = 0;
  std::size_t n_samples = 0;
  for (int replica = 0; replica < replicas; ++replica) {
    Case start = scene;
    start.plan.system.seed = static_cast<std::uint64_t>(replica + 1);
    Simulation simulation = resumed(start, cache(start), StepperKind::kScheduled);
    std::vector<double>& values = series.emplace_back();
    cpu += sample_every(kEvery, measure, fmt::format("S(t) of {}, seed {}", scene.label, replica + 1), simulation,
                        [&] { values.push_back(analysis::nematic_order(simulation.snapshot().director).order); });
    n_samples += values.size();
  }
  const double rod_seconds = scene.system().n_rods * kEvery * static_cast<double>(n_samples);
  return reduce_order(scene, series, kEvery, cpu / rod_seconds);
}

Json extrapolate(const std::vector<Json>& rows, const Case& large) {
  std::vector<double> sides, stds, taus;
  for (const Json& row : rows) {
    sides.push_back(row.at("side_mm"));
    stds.push_back(row.at("std"));
    taus.push_back(row.at("tau_s"));
  }
  const auto std_fit = fit_order(sides, stds, 0);
  const auto tau_fit = fit_order(sides, taus, 0);
  if (!std_fit || !tau_fit) return nullptr;
  const auto continued_to = [&](const OrderFit& fit) { return fit.coefficient * std::pow(large.side, fit.order); };
  const double cpu_per_rod_second = rows.back().at("cpu_s_per_rod_s");
  Json there{{"side_mm", large.side},
             {"n_rods", large.system().n_rods},
             {"std_power", std_fit->order},
             {"std_power_error", std_fit->order_error},
             {"tau_power", tau_fit->order},
             {"tau_power_error", tau_fit->order_error},
             {"cpu_s_per_rod_s", cpu_per_rod_second}};
  for (const double sem : kWanted) {
    const double time = time_for(sem, continued_to(*std_fit), continued_to(*tau_fit));
    there[fmt::format("time_s_for_sem_{:g}", sem)] = time;
    there[fmt::format("cpu_s_for_sem_{:g}", sem)] = time * large.system().n_rods * cpu_per_rod_second;
  }
  return there;
}

namespace {

std::string extrapolated_text(const Json& large) {
  const auto number = [&](const std::string& member) { return large.at(member).get<double>(); };
  std::string text = fmt::format(
      "\nExtrapolated to L = {:.10g} mm, N = {}: std ~ L^{:.2f} (+- {:.2f}), tau ~ L^{:.2f} (+- {:.2f}), {:.3g} CPU-s "
      "per rod-s\nas in the largest box measured. Power laws carried this far are no measurement.\n",
      number("side_mm"), large.at("n_rods").get<int>(), number("std_power"), number("std_power_error"),
      number("tau_power"), number("tau_power_error"), number("cpu_s_per_rod_s"));
  for (const double sem : kWanted) {
    text += fmt::format("  sem(S) = {:g}: {} simulated, {:.3g} CPU-hours\n", sem,
                        duration_text(number(fmt::format("time_s_for_sem_{:g}", sem))),
                        number(fmt::format("cpu_s_for_sem_{:g}", sem)) / 3600);
  }
  return text +
         "Replicas share that time between cores; each adds its way to the steady state. One more digit costs 100 "
         "times as much.\n";
}

}  // namespace

Report order_error_report(const std::vector<Json>& rows, const Json& extrapolated) {
  Report report("error", "accuracy error");
  report.add(rows);
  report.json["extrapolated"] = extrapolated;
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
      (extrapolated.is_null() ? "Too few boxes, or no power law: nothing is said of larger ones.\n"
                              : extrapolated_text(extrapolated));
  return report;
}

}  // namespace shaken::bench
