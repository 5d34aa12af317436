// SPDX-License-Identifier: MIT
#include "bench/effect_averages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>

#include "analysis/time_series.h"
#include "base/failure.h"
#include "bench/timing.h"

namespace shaken::bench {
namespace {

Estimate average_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  std::vector<double> times(values.size());
  for (std::size_t k = 0; k < times.size(); ++k) times[k] = ObservableSeries::kEvery * static_cast<double>(k);
  const analysis::SteadySummary summary = analysis::summarize_series(times, values, 0.0);
  Estimate average{.value = summary.mean, .sem = summary.sem, .n_effective = summary.n_effective};
  average.steady = summary.steady;
  if (summary.std == 0 && values.size() > 1) average.sem = 0;
  return average;
}

Json json_of(const Estimate& estimate) {
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  return {{"value", number(estimate.value)},
          {"sem", number(estimate.sem)},
          {"steady", estimate.steady ? Json(*estimate.steady) : Json(nullptr)}};
}

/// The names of what is not steady in a row.
std::vector<std::string> unsteady(const Json& averages) {
  std::vector<std::string> names;
  for (const auto& [name, of] : averages.items()) {
    if (of.at("steady") == false) names.push_back(name);
  }
  return names;
}

}  // namespace

Averages averages_of(const ObservableSeries& series) {
  Averages averages;
  for (std::size_t o = 0; o < averages.size(); ++o) averages[o] = average_of(series.values(kObservables[o].name));
  return averages;
}

Averages measure_averages(const Case& scene, const Cache& cache, double seconds) {
  value_or_fail(Simulation::start(scene.system()));
  Simulation simulation = resumed(scene, cache(scene), StepperKind::kScheduled);
  ObservableSeries series;
  sample_every(ObservableSeries::kEvery, seconds, "averages of " + scene.label, simulation,
               [&] { series.sample(simulation); });
  return averages_of(series);
}

Estimate ratio_of(const Estimate& a, const Estimate& b) {
  if (b.value == 0) return {};
  const double ratio = a.value / b.value;
  return {ratio, std::hypot(a.sem, ratio * b.sem) / std::abs(b.value)};
}

Json json_of(const Averages& averages) {
  Json json = Json::object();
  for (std::size_t o = 0; o < averages.size(); ++o) json[kObservables[o].name] = json_of(averages[o]);
  return json;
}

Json averages_row(const std::string& without, const std::string& neutral, const Averages& averages,
                  const Averages& everything) {
  Json row{{"without", without}, {"neutral", neutral}, {"averages", json_of(averages)}};
  for (std::size_t o = 0; o < averages.size(); ++o) {
    Json ratio = json_of(ratio_of(averages[o], everything[o]));
    ratio.erase("steady");
    row["relative"][kObservables[o].name] = ratio;
  }
  return row;
}

std::string averages_text(const Json& report) {
  std::string text = "With everything on:\n";
  const Json& everything = report.at("everything");
  for (const Observable& of : kObservables) {
    const Json& mean = everything.at(of.name);
    const auto number = [&](const char* member) {
      return mean.at(member).is_null() ? std::string("-") : fmt::format("{:.4g}", mean.at(member).get<double>());
    };
    text += fmt::format("  {:15} {} +- {} {}\n", of.name, number("value"), number("sem"),
                        std::string(of.unit) == "1" ? "" : of.unit);
  }
  text += "\nWithout an effect, in % of that, each with its standard error:\n";
  std::vector<Column> columns{{"without", "without"}};
  for (const Observable& of : kObservables) {
    columns.push_back({of.name, fmt::format("relative/{}/value", of.name), "{:.1f}", 100});
    columns.push_back({"+-", fmt::format("relative/{}/sem", of.name), "{:.1f}", 100});
  }
  text += table(report.at("rows"), columns);
  const auto mention = [&](const std::string& scene, const Json& averages) {
    const std::vector<std::string> names = unsteady(averages);
    if (!names.empty()) text += fmt::format("Not steady {}: {}\n", scene, fmt::join(names, ", "));
  };
  mention("with everything on", everything);
  for (const Json& row : report.at("rows")) mention("without " + text_of(row, "without"), row.at("averages"));
  return text;
}

}  // namespace shaken::bench
