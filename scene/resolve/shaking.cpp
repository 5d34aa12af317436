#include <fmt/format.h>

#include "scene/keys/derived.h"
#include "scene/resolve/resolution.h"

namespace shaken::scene {

namespace {

/// Rods pile up at what stands upright. In a square of 42 mm the deepest overlap within 10 s is 8 um at one degree and
/// 16 us, against 5 um on level plates; at ten degrees rods are pressed into the lid within 0.15 s. [degrees]
constexpr double kMostInclinationWithWalls = 1.0;

void with_weight(Resolution& scene) {
  System& system = scene.plan.system;
  const double gamma = scene.number("plates.gamma");
  if (!scene.given("plates.amplitude")) {
    system.amplitude = amplitude_for(gamma, system.frequency, system.gravity);
    scene.check_derived("plates.amplitude", {"plates.gamma", "plates.frequency"});
  } else if (!scene.given("plates.gamma")) {
    scene.check_derived("plates.gamma", {"plates.amplitude", "plates.frequency"});
  } else if (!scene.given("plates.frequency") && system.amplitude > 0 && gamma > 0) {
    system.frequency = frequency_for(gamma, system.amplitude, system.gravity);
    scene.check_derived("plates.frequency", {"plates.gamma", "plates.amplitude"});
  } else if (!agree(*gamma_of(system), gamma)) {
    scene.report(
        {"plates.gamma"},
        fmt::format("plates.gamma {:.10g} contradicts plates.amplitude {} at plates.frequency {} and gravity {}, "
                    "which make {:.10g}; remove one",
                    gamma, length_text(system.amplitude), format_quantity(system.frequency, Dimension::kFrequency),
                    format_quantity(system.gravity, Dimension::kAcceleration), *gamma_of(system)));
  }
}

/// Gamma compares the plates with gravity. Without it only Gamma = 0, plates at rest, means anything.
void without_weight(Resolution& scene) {
  System& system = scene.plan.system;
  if (scene.given("plates.gamma") && scene.number("plates.gamma") != 0) {
    scene.report(
        {"plates.gamma"},
        "plates.gamma compares the plates with gravity, which is 0; give plates.amplitude and plates.frequency "
        "instead");
  } else if (!scene.given("plates.amplitude")) {
    system.amplitude = 0;
    if (scene.given("plates.gamma")) return;
    scene.report({"gravity"},
                 "without gravity plates.gamma has no meaning; give plates.amplitude (0: plates at rest) and "
                 "plates.frequency");
  } else if (scene.given("plates.gamma") && system.amplitude > 0) {
    scene.report({"plates.gamma"}, fmt::format("plates.gamma 0 contradicts plates.amplitude {}; remove one",
                                               length_text(system.amplitude)));
  } else if (system.amplitude > 0 && !scene.given("plates.frequency")) {
    scene.report({"gravity"},
                 fmt::format("without gravity plates.amplitude {} does not tell plates.frequency; give that too",
                             length_text(system.amplitude)));
  }
}

}  // namespace

bool resolve_shaking(Resolution& scene) {
  if (!scene.ok({"plates.gamma", "plates.amplitude", "plates.frequency", "gravity"})) return false;
  const std::size_t n_before = scene.problems.size();
  if (scene.plan.system.gravity == 0) {
    without_weight(scene);
  } else {
    with_weight(scene);
  }
  return scene.problems.size() == n_before;
}

void check_base(Resolution& scene) {
  const System& system = scene.plan.system;
  if (!system.base && system.gravity > 0 && scene.ok({"plates.base", "gravity"})) {
    scene.report({"plates.base", "gravity"}, "without a base rods fall out of sight: set gravity to 0");
  }
}

void check_horizontal_vibration(Resolution& scene) {
  const System& system = scene.plan.system;
  if (!(system.horizontal_amplitude > 0) || !scene.ok({"plates.horizontal_amplitude"})) return;
  const auto refuse = [&](const char* block, const char* what) {
    scene.report({"plates.horizontal_amplitude", block},
                 fmt::format("{0} would move through the plane with the plates, and the simulator knows {0} that only "
                             "rise and fall: remove {1}, or set plates.horizontal_amplitude to 0",
                             what, block));
  };
  if (system.walls) refuse("walls", "side walls");
  if (system.posts) refuse("posts", "posts");
}

void check_inclination(Resolution& scene) {
  const System& system = scene.plan.system;
  if (!(system.inclination > kMostInclinationWithWalls) || !scene.ok({"plates.inclination"})) return;
  const auto refuse = [&](const char* block, const char* what) {
    scene.report(
        {"plates.inclination", block},
        fmt::format("on a slope of {:.4g} degrees rods would lie on {} and on each other, and impacts alone do not "
                    "keep those apart: at most {} degree with {}, or none of these",
                    system.inclination, what, kMostInclinationWithWalls, what));
  };
  if (system.walls) refuse("walls", "side walls");
  if (system.posts) refuse("posts", "posts");
}

void check_lid_motion(Resolution& scene) {
  const System& system = scene.plan.system;
  if (!system.lid_motion || system.lid || !scene.ok({"plates.lid"})) return;
  scene.report({"plates.lid_motion", "plates.lid"},
               "there is no lid that could move: remove plates.lid_motion, or set plates.lid to true");
}

}  // namespace shaken::scene
