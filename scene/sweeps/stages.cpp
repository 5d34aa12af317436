#include "scene/sweeps/stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/canonical.h"
#include "scene/keys/keys.h"
#include "scene/length.h"
#include "sim/start/from_another_run.h"

namespace shaken::scene {

std::vector<Axis> Protocol::settings(std::size_t k) const {
  std::vector<Axis> all;
  for (std::size_t i = 0; i <= k; ++i) {
    for (const Axis& axis : stages_[i]) {
      const auto known = std::find_if(all.begin(), all.end(), [&](const Axis& one) { return one.path == axis.path; });
      if (known == all.end()) {
        all.push_back(axis);
      } else {
        *known = axis;
      }
    }
  }
  return all;
}

void Protocol::name_the_rest(const RunPlan& plan, nlohmann::ordered_json& parameters) const {
  const nlohmann::ordered_json scene = to_json(plan);
  for (const Stage& stage : stages_) {
    for (const Axis& axis : stage) {
      std::string pointer = "/" + axis.path;
      std::replace(pointer.begin(), pointer.end(), '.', '/');
      const nlohmann::ordered_json::json_pointer place(pointer);
      if (parameters.contains(axis.path)) continue;
      if (scene.contains(place)) {
        parameters[axis.path] = scene.at(place);  // with what has been derived
      } else {                                    // left out there, for it has its default
        const Field& field = field_at(axis.path);
        parameters[axis.path] = keys::to_json(field, fields().value(plan, field));
      }
    }
  }
}

std::optional<Place> Protocol::place(std::size_t k) const {
  return stages_[k].empty() ? std::nullopt : std::optional(stages_[k].front().key);
}

void begin_where_another_ends(Draft& draft, std::vector<Problem>& problems) {
  const Place here = draft.place();
  const auto text = [&](const char* words) {
    Node node;
    node.place = here;
    node.kind = Node::Kind::kString;
    node.text = words;
    return node;
  };
  for (const Field& field : fields()) {
    if (field.path.starts_with("rods.start")) draft.assign(field.path, here, Node{}, problems);
  }
  draft.assign("start.run", here, text("0000000000000000"), problems);
  draft.assign("start.time", here, text("1 s"), problems);
}

std::string cannot_follow(const RunPlan& plan, const RunPlan& former) {
  if (former.until) return "with `until`, the time at which that ends is not known before";
  if (const std::string differs = start_mismatch(plan.system, former.system); !differs.empty()) {
    const bool is_number = plan.system.n_rods != former.system.n_rods;
    return fmt::format("not the same in both: {}{}", differs,
                       is_number ? " (a stage that names rods.area_fraction keeps the rods and changes the box if the "
                                   "scene gives rods.count and not box.side)"
                                 : "");
  }
  const double dt = former.system.dt;
  const Tick end = total_ticks(former);
  const double off = off_the_beat(former.system, end);
  if (std::abs(off) <= 0.5 * dt * (1 + 1e-6)) return "";
  return fmt::format("that ends in the middle of a vibration, at {:.10g} s, and the plates would jump; {}",
                     static_cast<double>(end) * dt, nearest_beat(former.system, end));
}

}  // namespace shaken::scene
