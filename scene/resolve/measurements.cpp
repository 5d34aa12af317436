#include <fmt/format.h>

#include "scene/keys/observables.h"
#include "scene/resolve/resolution.h"

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

void scattering(const Resolution& scene, MeasureScattering& settings) {
  if (!scene.ok({"rods.length", "measure.scattering.wavelength"})) return;
  settings.wavelength = settings.wavelength_for(scene.plan.system.rod.length);
}

void van_hove(Resolution& scene, MeasureVanHove& settings) {
  if (scene.ok({"rods.length", "measure.van_hove.range"})) {
    settings.range = settings.range_for(scene.plan.system.rod.length);
  }
  if (!scene.ok({"measure.van_hove.every", "measure.van_hove.lag"}) || settings.lag >= settings.every) return;
  scene.report({"measure.van_hove.lag", "measure.van_hove.every"},
               fmt::format("measure.van_hove.lag {} is shorter than measure.van_hove.every {}", time_text(settings.lag),
                           time_text(settings.every)));
}

void clusters(const Resolution& scene, MeasureClusters& settings) {
  if (!scene.ok({"rods.mid_diameter", "measure.clusters.distance"})) return;
  settings.distance = settings.distance_for(scene.plan.system.rod.mid_diameter);
}

void mixing(Resolution& scene, MeasureMixing& settings) {
  if (!scene.ok({"rods.length", "box.side", "box.aspect", "measure.mixing.distance"})) return;
  const System& system = scene.plan.system;
  const double half_box = system.box().shorter() / 2;
  settings.distance = settings.distance_for(system.rod.length, 2 * half_box);
  if (settings.distance <= half_box * (1 + 1e-12)) return;
  scene.report({"measure.mixing.distance", "box.side", "box.aspect"},
               fmt::format("neighbours at {} are farther than half the box, {}: distances have no nearest image there",
                           length_text(settings.distance), length_text(half_box)));
}

void defect_maps(Resolution& scene, MeasureDefectMaps& settings) {
  if (scene.ok({"rods.length", "measure.defect_maps.separation", "measure.defect_maps.smoothing",
                "measure.defect_maps.grid"})) {
    const double rod_length = scene.plan.system.rod.length;
    settings.separation = settings.separation_for(rod_length);
    settings.smoothing = settings.smoothing_for(rod_length);
    settings.grid = settings.grid_for(rod_length);
  }
  if (!scene.ok({"rods.length", "box.side", "box.aspect", "measure.defect_maps.range"})) return;
  const System& system = scene.plan.system;
  const double half_box = system.box().shorter() / 2;
  settings.range = settings.range_for(system.rod.length, 2 * half_box);
  if (settings.range <= half_box * (1 + 1e-12)) return;
  scene.report({"measure.defect_maps.range", "box.side", "box.aspect"},
               fmt::format("a map of {} each way reaches beyond half the box, {}: rods have no nearest image there",
                           length_text(settings.range), length_text(half_box)));
}

void density(Resolution& scene, MeasureDensity& settings) {
  if (scene.ok({"rods.length", "measure.density.grid"})) {
    settings.grid = settings.grid_for(scene.plan.system.rod.length);
  }
  if (!scene.ok({"measure.density.every", "measure.density.duration"}) || settings.duration >= settings.every) return;
  scene.report({"measure.density.duration", "measure.density.every"},
               fmt::format("measure.density.duration {} is shorter than measure.density.every {}",
                           time_text(settings.duration), time_text(settings.every)));
}

}  // namespace

void resolve_measurements(Resolution& scene) {
  RunPlan& plan = scene.plan;
  if (plan.velocity) velocity(scene, *plan.velocity);
  if (plan.defects) defects(scene, *plan.defects);
  if (plan.pairs) pairs(scene, *plan.pairs);
  if (plan.scattering) scattering(scene, *plan.scattering);
  if (plan.van_hove) van_hove(scene, *plan.van_hove);
  if (plan.clusters) clusters(scene, *plan.clusters);
  if (plan.mixing) mixing(scene, *plan.mixing);
  if (plan.defect_maps) defect_maps(scene, *plan.defect_maps);
  if (plan.density) density(scene, *plan.density);
}

void check_surroundings(Resolution& scene) {
  const System& system = scene.plan.system;
  for (const Observable& observable : observables()) {
    const std::string& block = observable.block.path;
    if (!scene.draft.is_on(block)) continue;
    if (observable.is_of_squares && system.box_aspect != 1 && !system.walls) {
      scene.report({block, "box.aspect"}, fmt::format("{} is of square boxes only; remove it or box.aspect", block));
    }
    if (!observable.within_walls() && system.walls) {
      scene.report({block, "walls"},
                   fmt::format("{} is of {} of a periodic box: walls leave none", block, observable.periodic));
    } else if (!observable.among_posts() && system.posts) {
      const bool is_periodic = !observable.within_walls();
      scene.report({block, "posts"},
                   fmt::format("{} is of {}, which posts interrupt: remove it or posts", block,
                               is_periodic ? observable.periodic + " of a periodic box" : observable.open));
    }
  }
}

}  // namespace shaken::scene
