#include "scene/canonical.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <utility>

#include "sim/physics_version.h"

namespace shaken::scene {

namespace {

nlohmann::ordered_json& object_at(nlohmann::ordered_json& scene, std::string_view path) {
  nlohmann::ordered_json* object = &scene;
  while (!path.empty()) {
    const std::size_t dot = path.find('.');
    object = &(*object)[std::string(path.substr(0, dot))];
    path = dot == std::string_view::npos ? std::string_view{} : path.substr(dot + 1);
  }
  return *object;
}

std::string hash_of(const RunPlan& plan, nlohmann::ordered_json scene) {
  scene.erase("stream");
  const std::string text = fmt::format("shaken physics {}\n{}", physics_version(plan.system), scene.dump());
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

}  // namespace

nlohmann::ordered_json to_json(const RunPlan& plan) {
  nlohmann::ordered_json scene = nlohmann::ordered_json::object();
  for (const Field& field : fields()) {
    const Value value = fields().value(plan, field);
    if (std::holds_alternative<std::monostate>(value)) continue;  // has no meaning in this plan
    if (field.omit_if_default && value == field.fallback) continue;
    if (field.form != Form::kBlock) {
      object_at(scene, field.path) = keys::to_json(field, value);
    } else if (std::get<bool>(value)) {
      object_at(scene, field.path) = nlohmann::ordered_json::object();
    } else if (std::get<bool>(field.fallback)) {  // off, though it would be on if nothing were said
      object_at(scene, field.path) = nullptr;
    }
  }
  return scene;
}

std::string run_id(const RunPlan& plan) {
  nlohmann::ordered_json scene = to_json(plan);
  scene.erase("until");
  scene["time"].erase("measure");
  return hash_of(plan, std::move(scene));
}

std::string scene_hash(const RunPlan& plan) { return hash_of(plan, to_json(plan)); }

}  // namespace shaken::scene
