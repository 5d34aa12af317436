// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/table.h"
#include "bench/accuracy/report.h"
#include "bench/accuracy/style.h"
#include "bench/picture.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<double, 3> kWanted{0.01, 0.001, 0.0001};  ///< errors of S whose cost is printed

/// "3.2 s", "5.1 min", "12 h", "40 d": three digits at most, whatever the size.
std::string time_text(double seconds) {
  const std::array<std::pair<double, const char*>, 4> units{{{86400, "d"}, {3600, "h"}, {60, "min"}, {1, "s"}}};
  for (const auto& [size, name] : units) {
    if (seconds >= 2 * size) return fmt::format("{:.3g} {}", seconds / size, name);
  }
  return fmt::format("{:.3g} s", seconds);
}

}  // namespace

std::string as_text(const std::vector<OrderError>& measured, const std::optional<Extrapolation>& large) {
  std::string text = accuracy_heading();
  text +=
      "\nStatistical error of S over a simulated time T: sem = c / sqrt(T / 2 tau). tau: integrated autocorrelation\n"
      "time of S(t); c: from the scatter of means over stretches of at least 5 tau, to be compared with std, the "
      "spread\n"
      "of S(t). Scatter: of the replicas' means, measured and by that formula.\n";
  std::vector<Row> rows{{"L mm", "N", "replicas", "T s", "T/tau", "S", "std", "tau s", "c", "c/std", "scatter",
                         "expected", "CPU-s/rod-s", "CPU for 0.01", "0.001", "0.0001"}};
  for (const OrderError& of : measured) {
    Row row{fmt::format("{:.10g}", of.scene.side),
            std::to_string(of.scene.system().n_rods),
            std::to_string(of.replicas.size()),
            fmt::format("{:.4g}", of.measured),
            fmt::format("{:.0f}", of.measured / of.tau),
            fmt::format("{:.4f}", of.mean),
            fmt::format("{:.4f}", of.std),
            fmt::format("{:.3g}", of.tau),
            of.c ? fmt::format("{:.4f} +- {:.4f}", of.c->value, of.c->sem) : "-",
            of.c ? fmt::format("{:.2f}", of.c->value / of.std) : "-",
            of.replicas.size() > 1 ? fmt::format("{:.4f}", of.replica_scatter()) : "-",
            fmt::format("{:.4f}", of.expected_scatter()),
            fmt::format("{:.3g}", of.cpu_per_rod_second)};
    for (const double sem : kWanted) row.push_back(time_text(of.cpu_for(sem)));
    rows.push_back(row);
  }
  text += aligned(rows);
  text += "T/tau below 100: tau, and all that follows from it, is rough.\n";
  if (!large) return text + "Too few boxes, or no power law: nothing is said of larger ones.\n";
  text += fmt::format(
      "\nExtrapolated to L = {:.10g} mm, N = {}: std ~ L^{:.2f} (+- {:.2f}), tau ~ L^{:.2f} (+- {:.2f}), {:.3g} CPU-s "
      "per "
      "rod-s\nas in the largest box measured. Power laws carried this far are no measurement.\n",
      large->side, large->n_rods, large->std.order, large->std.order_error, large->tau.order, large->tau.order_error,
      large->cpu_per_rod_second);
  for (const double sem : kWanted) {
    text += fmt::format("  sem(S) = {:g}: {} simulated, {:.3g} CPU-hours\n", sem, time_text(large->time_for(sem)),
                        large->cpu_for(sem) / 3600);
  }
  return text +
         "Replicas share that time between cores; each adds its way to the steady state. One more digit costs 100 "
         "times as much.\n";
}

Json as_json(const std::vector<OrderError>& measured, const std::optional<Extrapolation>& large) {
  Json report = accuracy_head("error");
  for (const OrderError& of : measured) {
    Json row{{"side_mm", of.scene.side},
             {"n_rods", of.scene.system().n_rods},
             {"replicas", of.replicas.size()},
             {"measured_s", of.measured},
             {"mean", of.mean},
             {"std", of.std},
             {"tau_s", of.tau}};
    row["c"] = of.c ? Json(of.c->value) : Json(nullptr);
    row["c_error"] = of.c ? Json(of.c->sem) : Json(nullptr);
    row["replica_scatter"] = of.replica_scatter();
    row["expected_scatter"] = of.expected_scatter();
    row["cpu_s_per_rod_s"] = of.cpu_per_rod_second;
    for (const StretchError& error : of.errors) {
      row["stretch_s"].push_back(error.time);
      row["sem"].push_back(error.sem);
      row["sem_error"].push_back(error.sem_error);
    }
    report["rows"].push_back(std::move(row));
  }
  report["extrapolated"] = nullptr;
  if (large) {
    report["extrapolated"] = {{"side_mm", large->side},
                              {"n_rods", large->n_rods},
                              {"std_power", large->std.order},
                              {"std_power_error", large->std.order_error},
                              {"tau_power", large->tau.order},
                              {"tau_power_error", large->tau.order_error},
                              {"cpu_s_for_sem_0.001", large->cpu_for(0.001)}};
  }
  return report;
}

void draw_order_error(const std::filesystem::path& folder, const std::vector<OrderError>& measured) {
  std::string data = "# T [s]  sem of S  its error  CPU time [s], a block per box\n";
  std::string script = multiplot("error", 2);
  script += "set format x '10^{%L}'\nset ylabel 'statistical error of S'\nset key off\n";
  for (const OrderError& of : measured) {
    for (const StretchError& error : of.errors) {
      data += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", error.time, error.sem, error.sem_error,
                          error.time * of.scene.system().n_rods * of.cpu_per_rod_second);
    }
    data += "\n\n";
  }
  for (const bool cpu : {false, true}) {
    script +=
        fmt::format("unset label\nset title '{}'\nset xlabel '{}' offset 0,0.6\n",
                    cpu ? "against CPU time" : "against simulated time", cpu ? "CPU time (s)" : "simulated time T (s)");
    std::string plot = "plot ";
    for (std::size_t k = 0; k < measured.size(); ++k) {
      const OrderError& of = measured[k];
      const double per_second = cpu ? of.scene.system().n_rods * of.cpu_per_rod_second : 1;
      const double longest = of.errors.back().time;
      plot +=
          fmt::format("'error.dat' index {} using {}:2:3 with yerrorbars pointtype 7 pointsize 0.8 linecolor '{}', ", k,
                      cpu ? 4 : 1, colour(k));
      plot += fmt::format("[{:.6g}:{:.6g}] {:.6g}/sqrt(x) with lines linewidth 1 linecolor '{}', ",
                          2 * of.tau * per_second, 10 * longest * per_second,
                          (of.c ? of.c->value : of.std) * std::sqrt(2 * of.tau * per_second), colour(k));
      if (!cpu) {
        script +=
            fmt::format("set label {} \"L {:g} mm, τ {:.2g} s\" at graph 0.04,{:.3f} textcolor '{}' font ',13' front\n",
                        k + 1, of.scene.side, of.tau, 0.06 + 0.075 * static_cast<double>(k), colour(k));
      }
    }
    plot.resize(plot.size() - 2);
    script += plot + "\n";
  }
  draw(folder, "error", data, script + "unset multiplot\n");
}

}  // namespace shaken::bench
