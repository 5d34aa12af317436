#include "run/loop/import_id.h"

#include <fmt/format.h>
#include <xxhash.h>

#include "scene/canonical.h"

namespace shaken::run {

scene::RunPlan without_start(scene::RunPlan plan) {
  const System placed;
  plan.start.reset();
  plan.system.start = placed.start;
  plan.system.start_angle = placed.start_angle;
  plan.system.start_domains = placed.start_domains;
  plan.system.start_separation = placed.start_separation;
  return plan;
}

std::string import_id(const scene::RunPlan& plan, const Simulation& simulation) {
  const std::string text =
      fmt::format("shaken import\n{}\n{:016x}", scene::run_id(without_start(plan)), simulation.state_hash());
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

}  // namespace shaken::run
