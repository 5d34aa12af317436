#include "run/recorded/tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "run/import/place_rods.h"
#include "scene/canonical.h"
#include "scene/load.h"

namespace shaken::run {

Tick ticks_between(double interval, const scene::RunPlan& plan) {
  return std::max<Tick>(1, static_cast<Tick>(std::ceil(interval / plan.system.dt)));
}

keys::Loaded<scene::RunPlan> plan_of_tracks(const scene::RunPlan& plan, const std::string& file, const Tracks& tracks) {
  nlohmann::ordered_json scene = scene::to_json(plan);
  scene["rods"].erase("start");
  const std::vector<std::string> species = species_names(plan.system);
  for (std::size_t k = 0; k < species.size(); ++k) {
    scene[species[k]].erase("area_fraction");
    scene[species[k]]["count"] = tracks.n_rods.at(k);
  }
  scene["time"]["step"] = tracks.interval / static_cast<double>(ticks_between(tracks.interval, plan));
  const double length = tracks.interval * static_cast<double>(std::max<std::size_t>(tracks.n_frames, 2) - 1);
  scene["time"]["measure"] = std::max(length - plan.steady.value_or(0), tracks.interval);
  return scene::load_scene(scene.dump(), file + ", as a scene");
}

void fold_into_box(Snapshot& frame, const Vec2& period, std::span<LastSeen> last) {
  frame.image.assign(frame.n_rods(), {});
  for (std::size_t i = 0; i < frame.n_rods(); ++i) {
    LastSeen* const before = last.empty() ? nullptr : &last[frame.track_of(i)];
    for (std::size_t k = 0; k < 2; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double side = period[axis];
      if (side == 0) continue;
      double& at = frame.position[i][axis];
      std::int32_t& image = frame.image[i][k];
      image = static_cast<std::int32_t>(std::floor(at / side));
      at -= image * side;
      if (before != nullptr && before->is_known) {
        const double moved = at - before->position[axis];
        image = before->image[k] - static_cast<std::int32_t>(std::lround(moved / side));
      }
    }
    if (before != nullptr) *before = {frame.position[i], frame.image[i], true};
  }
}

void set_velocities(std::span<Snapshot> frames, double interval) {
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, frames.size() - 1);
    const double span = interval * static_cast<double>(after - before);
    frames[k].velocity.clear();
    for (std::size_t i = 0; i < frames[k].n_rods(); ++i) {
      frames[k].velocity.emplace_back((frames[after].unwrapped(i) - frames[before].unwrapped(i)) / span);
    }
  }
}

std::string remark_on_velocities(std::size_t n_frames, double interval) {
  return fmt::format("velocities are displacements from the frame before to the one after, over {:.6g} s",
                     (n_frames > 2 ? 2 : 1) * interval);
}

}  // namespace shaken::run
