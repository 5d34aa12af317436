#include "run/recorded/tracks.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/canonical.h"
#include "scene/load.h"

namespace shaken::run {

Tick ticks_between(double interval, const scene::RunPlan& plan) {
  return std::max<Tick>(1, static_cast<Tick>(std::ceil(interval / plan.system.dt)));
}

keys::Loaded<scene::RunPlan> plan_of_tracks(const scene::RunPlan& plan, const std::string& file, const Tracks& tracks) {
  nlohmann::ordered_json scene = scene::to_json(plan);
  scene["rods"].erase("start");
  scene["rods"].erase("area_fraction");
  scene["rods"]["count"] = tracks.n_rods;
  scene["time"]["step"] = tracks.interval / static_cast<double>(ticks_between(tracks.interval, plan));
  const double length = tracks.interval * static_cast<double>(std::max<std::size_t>(tracks.n_frames, 2) - 1);
  scene["time"]["measure"] = std::max(length - plan.steady.value_or(0), tracks.interval);
  return scene::load_scene(scene.dump(), file + ", as a scene");
}

void fold_into_box(Snapshot& frame, const Vec2& period, const Snapshot* before) {
  frame.image.assign(frame.n_rods(), {});
  for (std::size_t i = 0; i < frame.n_rods(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double side = period[axis];
      if (side == 0) continue;
      double& at = frame.position[i][axis];
      std::int32_t& image = frame.image[i][k];
      image = static_cast<std::int32_t>(std::floor(at / side));
      at -= image * side;
      if (before != nullptr) {
        const double moved = at - before->position[i][axis];
        image = before->image[i][k] - static_cast<std::int32_t>(std::lround(moved / side));
      }
    }
  }
}

}  // namespace shaken::run
