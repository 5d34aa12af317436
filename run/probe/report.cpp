// SPDX-License-Identifier: MIT
#include "run/probe/report.h"

#include "run/effects.h"

namespace shaken::run {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::array<const char*, kPhases> kStageWhat{
    "rods against base, lid and walls",  "overlapping beads of neighbouring rods",   "impulses between rods",
    "new flights of rods that were hit", "bounds on the times to the next contacts", "what comes up at which tick",
    "which rods are near each other"};

/// CPU time that an effect takes by itself, and a word on it where there is one.
struct OwnCost {
  std::optional<double> cpu;  ///< [s]; none where it cannot be told apart
  const char* note = "";
};

OwnCost cost_of(const std::string& effect, const Probe& probe) {
  const auto stage = [&](Phase phase) { return probe.stages[static_cast<std::size_t>(phase)] * probe.stepping(); };
  if (const auto found = probe.impulse_cpu.find(effect); found != probe.impulse_cpu.end()) {
    return {found->second, "in the impulse law"};
  }
  if (const auto found = probe.samples.find(effect); found != probe.samples.end()) return {found->second.cpu(), ""};
  if (effect == "rod_rod_collisions") {
    return {stage(Phase::kDetection) + stage(Phase::kResponse), "stages detection and response"};
  }
  if (effect == "rod_base_collisions" || effect == "rod_lid_collisions" || effect == "side_walls") {
    return {stage(Phase::kPlates), "stage plates, all surfaces together"};
  }
  if (effect == "trajectory") return {probe.trajectory.cpu(), ""};
  if (effect == "stream") return {probe.stream.cpu(), ""};
  if (effect == "movie") {
    if (!probe.movie_trouble.empty()) return {std::nullopt, "could not be timed"};
    return {probe.movie.cpu(), "in a process of its own"};
  }
  return {std::nullopt, "no steps of its own"};
}

}  // namespace

OrderedJson probe_report(const scene::RunPlan& plan, const std::optional<Probe>& probe) {
  OrderedJson report;
  const double total = probe ? probe->total() : 0;
  report["effects"] = OrderedJson::array();
  for (const EffectLine& line : list_effects(plan)) {
    OrderedJson entry{{"name", line.name}, {"what", line.what}, {"on", line.on}, {"why", line.why}};
    if (probe && line.on) {
      const OwnCost cost = cost_of(line.name, *probe);
      entry["cpu_share"] = cost.cpu ? OrderedJson(*cost.cpu / total) : OrderedJson();
      if (*cost.note != '\0') entry["note"] = cost.note;
    }
    report["effects"].push_back(std::move(entry));
  }
  if (!probe) return report;

  report["probe"] = {{"warm_up_s", probe->warm_up},
                     {"simulated_s", probe->simulated},
                     {"cpu_s", probe->cpu},
                     {"rod_seconds_per_cpu_second", plan.system.n_all_rods() * probe->simulated / probe->cpu}};
  report["stages"] = OrderedJson::array();
  for (std::size_t p = 0; p < kPhases; ++p) {
    report["stages"].push_back({{"name", kPhaseNames[p]},
                                {"what", kStageWhat[p]},
                                {"cpu_share", probe->stages[p] * probe->stepping() / total}});
  }
  report["snapshots_cpu_share"] = probe->snapshots.cpu() / total;
  report["checkpoints_cpu_share"] = probe->checkpoints.cpu() / total;
  report["cpu_seconds"] = total;
  report["stepping_cpu_seconds"] = probe->stepping();
  report["disk_bytes"] = {{"trajectory", probe->disk.trajectory},
                          {"observables", probe->disk.observables},
                          {"checkpoints", probe->disk.checkpoints},
                          {"total", probe->disk.total()}};
  return report;
}

}  // namespace shaken::run
