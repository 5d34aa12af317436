// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "scene/observables.h"
#include "scene/resolve/steps.h"

namespace shaken::scene {

namespace {

void velocity(Resolution& scene, const MeasureVelocity& settings) {
  if (!scene.ok({"measure.velocity.every", "measure.velocity.window"}) || settings.window >= settings.every) return;
  scene.report({"measure.velocity.window", "measure.velocity.every"},
               fmt::format("measure.velocity.window {} is shorter than measure.velocity.every {}",
                           time_text(settings.window), time_text(settings.every)));
}

void defects(const Resolution& scene, MeasureDefects& settings) {
  if (!scene.ok({"rods.length", "measure.defects.smoothing", "measure.defects.grid"})) return;
  const double rod_length = scene.plan.system.rod.length;
  settings.smoothing = settings.smoothing_for(rod_length);
  settings.grid = settings.grid_for(rod_length);
}

void pairs(Resolution& scene, MeasurePairs& settings) {
  if (!scene.ok({"rods.length", "box.side", "box.aspect", "measure.pairs.range"})) return;
  const System& system = scene.plan.system;
  const double half_box = system.box().shorter() / 2;
  settings.range = settings.range_for(system.rod.length, 2 * half_box);
  if (settings.range <= half_box * (1 + 1e-12)) return;
  scene.report(
      {"measure.pairs.range", "box.side", "box.aspect"},
      fmt::format("a map of {} each way reaches beyond half the box, {}: distances have no nearest image there",
                  length_text(settings.range), length_text(half_box)));
}

}  // namespace

void resolve_measurements(Resolution& scene) {
  RunPlan& plan = scene.plan;
  if (plan.velocity) velocity(scene, *plan.velocity);
  if (plan.defects) defects(scene, *plan.defects);
  if (plan.pairs) pairs(scene, *plan.pairs);
}

void check_walls(Resolution& scene) {
  const System& system = scene.plan.system;
  for (const Observable& observable : observables()) {
    const std::string& block = observable.block.path;
    if (!scene.draft.is_on(block)) continue;
    if (observable.is_of_squares && system.box_aspect != 1 && !system.walls) {
      scene.report({block, "box.aspect"}, fmt::format("{} is of square boxes only; remove it or box.aspect", block));
    }
    if (observable.within_walls() || !system.walls) continue;
    scene.report({block, "walls"},
                 fmt::format("{} is of {} of a periodic box: walls leave none", block, observable.periodic));
  }
}

}  // namespace shaken::scene
