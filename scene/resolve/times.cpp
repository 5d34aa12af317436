#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/keys/accuracy_levels.h"
#include "scene/keys/derived.h"
#include "scene/resolve/resolution.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

constexpr double kLeastTicksPerPeriod = 20;
// Of a bead's radius, beyond which a run ends: kMaxOverlapFraction in sim/tick/tick.h.
constexpr double kDeepestOverlap = 0.5;

}  // namespace

void resolve_accuracy(Resolution& scene) {
  System& system = scene.plan.system;
  const Given* word = scene.draft.find("accuracy");
  if (!word || !scene.ok({"accuracy", "time.step", "time.impacts"})) return;
  const AccuracyLevel* level = accuracy_level(std::get<std::string>(word->value));
  // a setting has the last word over what a file says, whichever of the keys it is
  const auto is_setting = [](const Given& given) { return given.place.line == 0; };
  const auto yields = [&](const char* path) {  // to the level
    const Given* other = scene.draft.find(path);
    return other == nullptr || (is_setting(*word) && !is_setting(*other));
  };
  const auto wins = [&](const char* path) {  // over the level
    const Given* other = scene.draft.find(path);
    return other != nullptr && !is_setting(*word) && is_setting(*other);
  };
  if (yields("time.step")) system.dt = level->step;
  if (yields("time.impacts")) system.impacts = level->impacts;
  if (system.dt != level->step && !wins("time.step")) {
    scene.report({"accuracy"},
                 fmt::format("accuracy \"{}\" is a time.step of {}, but time.step {} is given; remove one", level->name,
                             time_text(level->step), time_text(system.dt)));
  }
  if (system.impacts != level->impacts && !wins("time.impacts")) {
    scene.report({"accuracy"},
                 fmt::format("accuracy \"{}\" is time.impacts \"{}\", but time.impacts \"{}\" is given; remove one",
                             level->name, name_of(level->impacts), name_of(system.impacts)));
  }
}

bool check_step(Resolution& scene) {
  if (!scene.ok({"plates.frequency", "plates.gamma", "plates.amplitude"})) return false;
  const System& system = scene.plan.system;
  const auto is_fine = [&](double frequency) { return system.dt * frequency * kLeastTicksPerPeriod <= 1; };
  const auto refuse = [&](const char* key, double frequency) {
    return scene.refuse({"time.step", "accuracy", key, "plates.amplitude"},
                        fmt::format("a step of {} is too long for plates at {}: at most {}", time_text(system.dt),
                                    format_quantity(frequency, Dimension::kFrequency),
                                    time_text(1 / (kLeastTicksPerPeriod * frequency))));
  };
  if (!is_fine(system.frequency)) return refuse("plates.frequency", system.frequency);
  if (!system.second || !scene.ok({"plates.second.frequency"}) || is_fine(system.second->frequency)) return true;
  return refuse("plates.second.frequency", system.second->frequency);
}

void check_plates_in_a_tick(Resolution& scene) {
  System& system = scene.plan.system;
  if (!system.base && !system.lid) return;
  const double speed = system.peak_plate_speed();
  double thinnest = INFINITY;
  for (const RodGroup& group : rod_groups(system)) {
    for (const Species& size : sizes_of_species(group.rod))
      thinnest = std::min(thinnest, *std::min_element(size.bead_radius.begin(), size.bead_radius.end()));
  }
  const double deepest = kDeepestOverlap * thinnest;
  if (speed * system.dt <= deepest) return;
  scene.report({"time.step", "accuracy", "plates.gamma", "plates.amplitude", "plates.frequency",
                "plates.second.amplitude", "plates.second.frequency", "plates.lid_motion.amplitude"},
               fmt::format("plates as fast as {:.4g} mm/s move further in a step of {} than half the radius of the "
                           "thinnest bead, {}, the deepest overlap there may be: the run would end in numerical "
                           "trouble; take a step of at most {}, or shake less",
                           speed, time_text(system.dt), length_text(deepest), time_text(deepest / speed)));
}

void check_until(Resolution& scene) {
  const RunPlan& plan = scene.plan;
  if (!plan.until) return;
  if (!plan.order)
    scene.report({"until", "measure.order"}, "until asks for an error of S, which measure.order = null leaves out");
  if (scene.ok({"rods.beads"}) && !plan.system.rod.has_axis())
    scene.report({"until", "rods.beads"}, "until asks for an error of S, and spheres have no S: they have no axis");
  if (!scene.ok({"until.at_most", "time.measure"}) || plan.until->at_most >= plan.measure_time) return;
  scene.report({"until.at_most", "time.measure"},
               fmt::format("until.at_most {} is shorter than time.measure {}", time_text(plan.until->at_most),
                           time_text(plan.measure_time)));
}

namespace {

void check_placing(Resolution& scene) {
  const System& system = scene.plan.system;
  if (!scene.ok({"rods.start", "rods.start_angle"})) return;
  if (system.start_angle != 0 && system.start != Start::kAligned && system.start != Start::kDefectPair) {
    scene.report({"rods.start_angle", "rods.start"},
                 "only rods that start in rows, and the director beyond a pair of defects, have an angle: remove "
                 "rods.start_angle, or set rods.start to \"aligned\" or \"defect_pair\"");
  } else if (system.start_angle != 0 && system.start == Start::kAligned && system.walls) {
    scene.report({"rods.start_angle", "walls"},
                 "rows at an angle close around a periodic box, which walls take the place of: remove "
                 "rods.start_angle or walls");
  } else if (system.start_angle != 0 && system.start == Start::kAligned && system.posts) {
    scene.report(
        {"rods.start_angle", "posts"},
        "rows at an angle close around an empty box, in which no posts stand: remove rods.start_angle or posts");
  }
  if (is_compressed(system.start) && system.walls) {
    scene.report({"rods.start", "walls"},
                 "what is compressed is a periodic box, and walls would stand in the way: set rods.start to "
                 "\"aligned\" or \"random\", or remove walls");
  }
}

}  // namespace

void check_start(Resolution& scene) {
  check_placing(scene);
  if (!scene.plan.start) return;
  for (const char* path : {"start.run", "start.time"}) {
    if (!scene.draft.find(path)) scene.report({"start"}, fmt::format("{} is missing", path));
  }
  for (const char* given : {"rods.start", "rods.start_angle", "rods.start_domains", "rods.start_separation"}) {
    if (!scene.given(given)) continue;
    scene.report({given, "start"},
                 fmt::format("rods start in rows, at random, or from another run: remove {} or start", given));
    break;
  }
}

void check_intervals(Resolution& scene) {
  const double step = scene.plan.system.dt;
  if (scene.ok({"time.measure"}) && scene.plan.measure_time < step) {
    scene.report({"time.measure", "time.step", "accuracy"},
                 fmt::format("time.measure {} is shorter than time.step {}: nothing would be simulated",
                             time_text(scene.plan.measure_time), time_text(step)));
  }
  for (const Field& field : fields()) {
    const Field* block = fields().block_of(field);
    const bool is_interval = field.form == Form::kQuantity && field.dimension == Dimension::kTime && block != nullptr &&
                             field.path != "start.time";
    if (!is_interval || !scene.draft.is_on(block->path) || !scene.draft.is_ok(field.path)) continue;
    const double every = std::get<double>(field.fetch(scene.plan));
    if (every < step) {
      scene.report({field.path, "time.step", "accuracy"},
                   fmt::format("{} {} is shorter than time.step {}", field.path, time_text(every), time_text(step)));
    }
  }
}

}  // namespace shaken::scene
