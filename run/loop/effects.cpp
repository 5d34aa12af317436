#include "run/loop/effects.h"

#include <fmt/format.h>

#include "run/measure/measurement_kinds.h"
#include "scene/deciding_key.h"
#include "scene/keys/fields.h"
#include "sim/effects/registry.h"

namespace shaken::run {
namespace {

/// A block of the scene: on if it is there.
EffectLine of_block(const scene::RunPlan& plan, const std::string& name, const std::string& path,
                    const std::string& decisive) {
  const scene::Field& block = scene::field_at(path);
  EffectLine line{name, block.doc, std::get<bool>(block.fetch(plan)), path + " is absent"};
  const scene::Field& key = scene::field_at(path + "." + decisive);
  if (line.on) line.why = fmt::format("{} = {}", key.path, scene::show(key, key.fetch(plan)));
  return line;
}

}  // namespace

std::vector<EffectLine> list_effects(const scene::RunPlan& plan) {
  std::vector<EffectLine> lines;
  for (const Effect& effect : all_effects()) {
    lines.push_back({std::string(effect.name), std::string(effect.what), effect.is_on(plan.system),
                     scene::deciding_key(plan, effect.keys)});
  }
  for (const MeasurementKind& kind : measurement_kinds()) {
    const std::string name(kind.name);
    lines.push_back(of_block(plan, "measure_" + name, "measure." + name, "every"));
  }
  EffectLine trajectory = of_block(plan, "trajectory", "trajectory", "every");
  const EffectLine movie = of_block(plan, "movie", "movie", "every");
  if (movie.on && !trajectory.on) {  // the movie is drawn from the trajectory
    trajectory.on = true;
    trajectory.why = movie.why;
  }
  lines.push_back(std::move(trajectory));
  lines.push_back(of_block(plan, "stream", "stream", "rate"));
  lines.push_back(movie);
  return lines;
}

std::map<std::string, EffectReport> report_effects(const scene::RunPlan& plan, const OpenRun& run,
                                                   std::optional<std::int64_t> n_live_frames) {
  std::map<std::string, EffectReport> reports;
  for (const EffectLine& line : list_effects(plan)) reports[line.name].on = line.on;

  const World& world = run.simulation.world();
  for (const Effect& effect : all_effects()) {
    reports[std::string(effect.name)].work = {{std::string(effect.unit), static_cast<double>(effect.work(world))}};
  }
  for (const auto& [name, samples] : run.measurements.counts()) {
    reports["measure_" + name].work = {{"samples", static_cast<double>(samples)}};
  }
  const double frames = run.frames ? static_cast<double>(run.frames->n_frames()) : 0.0;
  reports["trajectory"].work = {{"frames", frames}};
  // asked for, but not sent where there is no bus
  reports["stream"] = {n_live_frames.has_value(), {{"frames", static_cast<double>(n_live_frames.value_or(0))}}};
  return reports;
}

}  // namespace shaken::run
