#include "scene/resolve/resolve.h"

#include "scene/resolve/resolution.h"

namespace shaken::scene {

std::optional<RunPlan> resolve(const Draft& draft, std::vector<Problem>& problems) {
  const std::size_t n_before = problems.size();
  Resolution scene{draft, problems};
  const bool all_ok = fields().store(draft, scene.plan);

  resolve_accuracy(scene);
  const bool shapes_are_known = resolve_rod_shapes(scene);
  const bool shaking_is_known = resolve_shaking(scene);
  if (shapes_are_known) {
    if (resolve_arena(scene) && resolve_posts(scene)) {
      resolve_numbers(scene);
      check_posts(scene);
    }
    check_box(scene);
    resolve_start_pattern(scene);
  }
  check_gap(scene);
  check_base(scene);
  check_horizontal_vibration(scene);
  check_inclination(scene);
  check_lid_motion(scene);
  resolve_contacts(scene);
  if (scene.ok({"time.step"})) {
    const bool step_is_fine = check_step(scene);
    if (step_is_fine && shapes_are_known && shaking_is_known) check_plates_in_a_tick(scene);
    check_intervals(scene);
    resolve_measurements(scene);
  }
  check_surroundings(scene);
  check_until(scene);
  check_start(scene);

  if (!all_ok || problems.size() > n_before) return std::nullopt;
  return scene.plan;
}

}  // namespace shaken::scene
