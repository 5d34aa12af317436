// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "base/table.h"
#include "bench/accuracy/report.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

const char* knob_of(const Statistics& of) { return kKnobNames[static_cast<std::size_t>(of.task.knob)]; }
const char* unit_of(const Statistics& of) { return kKnobUnits[static_cast<std::size_t>(of.task.knob)]; }

std::string mean_text(const Mean& mean) { return fmt::format("{:.4g} +- {:.1g}", mean.value, mean.sem); }
std::string percent_text(const Mean& bias) { return fmt::format("{:.2f} +- {:.2f}", 100 * bias.value, 100 * bias.sem); }
const char* verdict_text(Verdict verdict) {
  return verdict == Verdict::kBelow ? "below" : verdict == Verdict::kAbove ? "above" : "open";
}

Json mean_json(const Mean& mean) { return {{"value", mean.value}, {"sem", mean.sem}}; }

std::string heading_of(const Statistics& of) {
  return fmt::format("\n{}, N = {}, {}: {}; {} x {:.10g} s of each, after {:.10g} s\n", of.task.scene.label(),
                     of.task.scene.system().n_rods, of.task.variant->name, knob_of(of), of.task.replicas,
                     of.task.measure, of.task.settle);
}

/// "T_xy: 8 us (16 us: open)" for every observable with a limit.
std::string steps_below_text(const Statistics& of) {
  std::string text;
  for (int o = 0; o < kObservables; ++o) {
    if (!of.limits[o]) continue;
    std::vector<Mean> biases;
    for (const StatisticsPoint& point : of.points) biases.push_back(point.biases[o]);
    const auto last = last_below(biases, kBound);
    const std::size_t next = last ? *last + 1 : 0;
    std::string found = last ? fmt::format("{:.10g} us", of.points[*last].value) : "none";
    if (next < biases.size()) {
      found += fmt::format(" ({:.10g} us: {})", of.points[next].value, verdict_text(judge(biases[next], kBound)));
    }
    text += fmt::format("  {}: {}\n", kObservableInfo[o].name, found);
  }
  return text;
}

}  // namespace

std::string as_text(const std::vector<Statistics>& measured) {
  std::string text = accuracy_heading();
  for (const Statistics& of : measured) {
    text += heading_of(of);
    Row titles{fmt::format("{} {}", knob_of(of), unit_of(of)), "CPU-s/rod-s", "overlap um"};
    for (const ObservableInfo& info : kObservableInfo) titles.push_back(fmt::format("{} {}", info.name, info.unit));
    std::vector<Row> rows{titles};
    for (const StatisticsPoint& point : of.points) {
      Row row{fmt::format("{:.10g}", point.value), fmt::format("{:.3g}", point.cpu_per_rod_second),
              fmt::format("{:.2f}", 1e3 * point.max_overlap)};
      for (const Mean& mean : point.means) row.push_back(mean_text(mean));
      rows.push_back(row);
    }
    text += aligned(rows);
    text += of.task.knob == Knob::kStep
                ? fmt::format(
                      "Bias in % of the limit dt -> 0, a line through the steps up to {:g} us (chi2 per degree of "
                      "freedom below); of impulses, in % of the first row:\n",
                      of.limit_step())
                : "Difference from the first row in %:\n";
    rows = {{titles[0]}};
    for (const ObservableInfo& info : kObservableInfo) rows[0].emplace_back(info.name);
    for (const StatisticsPoint& point : of.points) {
      Row row{fmt::format("{:.10g}", point.value)};
      for (const Mean& bias : point.biases) row.push_back(percent_text(bias));
      rows.push_back(row);
    }
    if (of.task.knob == Knob::kStep) {
      Row row{"chi2/f"};
      for (const auto& limit : of.limits) {
        row.push_back(limit && limit->freedom > 0 ? fmt::format("{:.1f}", limit->chi_squared / limit->freedom) : "-");
      }
      rows.push_back(row);
    }
    text += aligned(rows);
    if (of.task.knob == Knob::kStep) {
      text += fmt::format(
          "Largest step up to which the bias is below {:g} % with two standard errors to spare (and the next step):\n",
          100 * kBound);
      text += steps_below_text(of);
    }
  }
  return text;
}

Json as_json(const std::vector<Statistics>& measured) {
  Json report = accuracy_head("statistical");
  report["limits"] = Json::array();
  report["tilt"] = Json::array();
  for (const Statistics& of : measured) {
    for (const StatisticsPoint& point : of.points) {
      Json row{{"length_mm", of.task.scene.length},
               {"area_fraction", of.task.scene.area_fraction},
               {"side_mm", of.task.scene.side},
               {"n_rods", of.task.scene.system().n_rods},
               {"variant", of.task.variant->name},
               {"knob", knob_of(of)},
               {"value", point.value},
               {"simulated_s", of.task.replicas * of.task.measure},
               {"cpu_s_per_rod_s", point.cpu_per_rod_second},
               {"max_overlap_mm", point.max_overlap}};
      for (int o = 0; o < kObservables; ++o) {
        row[kObservableInfo[o].name] = mean_json(point.means[o]);
        row[kObservableInfo[o].name]["bias"] = point.biases[o].value;
        row[kObservableInfo[o].name]["bias_error"] = point.biases[o].sem;
        row[kObservableInfo[o].name]["verdict"] = verdict_text(judge(point.biases[o], kBound));
      }
      report["rows"].push_back(std::move(row));
      report["tilt"].push_back({{"length_mm", of.task.scene.length},
                                {"variant", of.task.variant->name},
                                {"knob", knob_of(of)},
                                {"value", point.value},
                                {"n_z", point.tilt.n_z},
                                {"v_along", point.tilt.v_along},
                                {"v_along_sem", point.tilt.v_along_sem}});
    }
    for (int o = 0; o < kObservables; ++o) {
      if (!of.limits[o]) continue;
      report["limits"].push_back({{"length_mm", of.task.scene.length},
                                  {"variant", of.task.variant->name},
                                  {"observable", kObservableInfo[o].name},
                                  {"unit", kObservableInfo[o].unit},
                                  {"limit", mean_json(of.limits[o]->at_zero)},
                                  {"slope_per_us", mean_json(of.limits[o]->slope)},
                                  {"chi_squared", of.limits[o]->chi_squared},
                                  {"freedom", of.limits[o]->freedom}});
    }
  }
  return report;
}

}  // namespace shaken::bench
