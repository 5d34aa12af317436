#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/resolve/resolution.h"
#include "sim/rod/sizes.h"

namespace shaken::scene {

namespace {

/// Tip to tip, of the longest rods with an axis; 0 if all are spheres.
double longest_axis(System& system) {
  double longest = 0;
  for (const RodGroup& group : rod_groups(system)) {
    if (!group.rod.has_axis()) continue;
    for (const RodShape& size : sizes_of(group.rod)) longest = std::max(longest, size.length);
  }
  return longest;
}

void check_domains(Resolution& scene, double longest) {
  const System& system = scene.plan.system;
  if (!scene.ok({"rods.start_domains"})) return;
  const double width = std::sqrt(system.box().area() / system.start_domains);
  if (width >= longest) return;
  scene.report(
      {"rods.start_domains", "box.side", "rods.start"},
      fmt::format("{} domains are {} wide, less than a rod is long: at most {} have room", system.start_domains,
                  length_text(width), std::max(1, static_cast<int>(system.box().area() / (longest * longest)))));
}

void check_separation(Resolution& scene, double longest) {
  System& system = scene.plan.system;
  if (!scene.ok({"rods.start_separation"})) return;
  const double most = 0.5 * system.box().longer();
  if (!scene.given("rods.start_separation")) system.start_separation = most;
  if (system.start_separation > most * (1.0 + 1e-9)) {
    scene.report({"rods.start_separation"},
                 fmt::format("defects {} apart are nearer to each other around the periodic box: at most half its "
                             "longer side, {}",
                             length_text(system.start_separation), length_text(most)));
  } else if (system.start_separation < longest) {
    scene.report({"rods.start_separation", "box.side", "rods.start"},
                 fmt::format("defects {} apart, less than a rod is long, leave no director between them: at least {}",
                             length_text(system.start_separation), length_text(longest)));
  }
}

}  // namespace

void resolve_start_pattern(Resolution& scene) {
  System& system = scene.plan.system;
  if (!scene.ok({"rods.start"}) || scene.plan.start) return;
  const bool has_domains = system.start == Start::kPolydomain, has_defects = system.start == Start::kDefectPair;
  if (system.start_domains != System{}.start_domains && !has_domains) {
    scene.report({"rods.start_domains"},
                 "only a polydomain start has domains: remove rods.start_domains, or set rods.start to \"polydomain\"");
  }
  if (scene.given("rods.start_separation") && !has_defects) {
    scene.report({"rods.start_separation"},
                 "only a pair of defects has a separation: remove rods.start_separation, or set rods.start to "
                 "\"defect_pair\"");
  }
  if (!has_domains && !has_defects) return;
  const double longest = longest_axis(system);
  if (longest == 0) {
    scene.report({"rods.start"},
                 "spheres have no director: set rods.start to \"compressed\", \"random\" or \"aligned\"");
  } else if (scene.ok({"box.side", "box.aspect"})) {
    has_domains ? check_domains(scene, longest) : check_separation(scene, longest);
  }
}

}  // namespace shaken::scene
