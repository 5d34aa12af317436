// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "base/table.h"
#include "bench/accuracy/report.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string short_number(double value) { return fmt::format("{:.2e}", value); }

/// "1.03 +- 0.02 (9)"
std::string order_text(const std::optional<OrderFit>& fit) {
  return fit ? fmt::format("{:.2f} +- {:.2f} ({})", fit->order, fit->order_error, fit->points) : "none";
}

Json quartiles_json(const Quartiles& of) { return {{"lower", of.lower}, {"median", of.median}, {"upper", of.upper}}; }

}  // namespace

std::string as_text(const std::vector<Convergence>& measured) {
  std::string text = accuracy_heading();
  text +=
      "\nErrors against a converged solution at the end of each case: median over an ensemble of starts, and its\n"
      "quartiles for the position. CPU time of one start. Energy: kinetic, relative.\n";
  for (const Convergence& of : measured) {
    text += fmt::format("\n{} ({}), {}: {} starts, {:.3f} ms, {:.4g} impulses each\n", of.start->name, of.start->what,
                        of.variant->name, of.members, 1e3 * of.start->duration, of.impulses);
    std::vector<Row> rows{{"dt us", "position mm", "lower", "upper", "director rad", "energy", "scheduled us",
                           "reference us", "ratio", "same state", "trouble"}};
    for (const StepErrors& step : of.steps) {
      const Quartiles& position = step.errors[0];
      rows.push_back({fmt::format("{:.10g}", 1e6 * step.dt), short_number(position.median),
                      short_number(position.lower), short_number(position.upper), short_number(step.errors[1].median),
                      short_number(step.errors[2].median), fmt::format("{:.4g}", 1e6 * step.scheduled_cpu),
                      fmt::format("{:.4g}", 1e6 * step.reference_cpu),
                      fmt::format("{:.1f}", step.reference_cpu / step.scheduled_cpu), step.states_equal ? "yes" : "NO",
                      std::to_string(step.in_trouble)});
    }
    text += aligned(rows);
    text += fmt::format(
        "converged solution at {:.4g} ns; one of twice that step is off by {} mm, {} rad, {} (upper quartile)\n",
        1e9 * of.converged_dt, short_number(of.floor[0].upper), short_number(of.floor[1].upper),
        short_number(of.floor[2].upper));
    if (of.from_first) {
      text += fmt::format("distance from the converged solution of {}: {} mm, {} rad, {} (median)\n",
                          variants().front().name, short_number((*of.from_first)[0].median),
                          short_number((*of.from_first)[1].median), short_number((*of.from_first)[2].median));
    }
  }
  std::vector<Row> orders{{"case", "variant", "position", "director", "energy"}};
  for (const Convergence& of : measured) {
    orders.push_back({of.start->name, of.variant->name, order_text(of.orders[0]), order_text(of.orders[1]),
                      order_text(of.orders[2])});
  }
  text += fmt::format(
      "\nOrder of convergence: slope of the median error in log-log, its standard error, and from how many steps. The\n"
      "finest {} steps count, then each next one while it stays within a factor {:g} of the line; errors below {:g} "
      "times\n"
      "what the converged solution is off by do not.\n",
      kLeast, kOnLine, kAboveFloor);
  return text + aligned(orders);
}

Json as_json(const std::vector<Convergence>& measured) {
  Json report = accuracy_head("deterministic");
  report["orders"] = Json::array();
  for (const Convergence& of : measured) {
    for (const StepErrors& step : of.steps) {
      Json row{{"case", of.start->name},
               {"variant", of.variant->name},
               {"duration_s", of.start->duration},
               {"members", of.members},
               {"dt_s", step.dt}};
      for (int n = 0; n < kNorms; ++n) row["error"][kNormNames[n]] = quartiles_json(step.errors[n]);
      row["scheduled_cpu_s"] = step.scheduled_cpu;
      row["reference_cpu_s"] = step.reference_cpu;
      row["states_equal"] = step.states_equal;
      row["in_trouble"] = step.in_trouble;
      report["rows"].push_back(std::move(row));
    }
    Json orders{{"case", of.start->name},
                {"variant", of.variant->name},
                {"impulses", of.impulses},
                {"converged_dt_s", of.converged_dt}};
    for (int n = 0; n < kNorms; ++n) {
      Json& norm = orders[kNormNames[n]];
      norm["unit"] = kNormUnits[n];
      norm["floor"] = quartiles_json(of.floor[n]);
      if (of.from_first) norm["from_first"] = quartiles_json((*of.from_first)[n]);
      norm["order"] = nullptr;
      if (const auto& fit = of.orders[n]) {
        norm["order"] = fit->order;
        norm["order_error"] = fit->order_error;
        norm["coefficient"] = fit->coefficient;
        norm["finest_dt_s"] = of.steps[static_cast<std::size_t>(fit->first)].dt;
        norm["points"] = fit->points;
      }
    }
    report["orders"].push_back(std::move(orders));
  }
  return report;
}

}  // namespace shaken::bench
