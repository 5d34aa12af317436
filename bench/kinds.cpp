#include "bench/kinds.h"

namespace shaken::bench {

const std::vector<SceneKind>& scene_kinds() {
  static const std::vector<SceneKind> kinds{
      {"apolar rods", R"({})"},
      {"dilute", R"({"rods": {"area_fraction": 0.45}})"},
      {"short", R"({"rods": {"length": "2.5 mm", "area_fraction": 0.60}})"},
      {"spheres", R"({"rods": {"length": "0.8 mm", "end_diameter": "0.8 mm", "beads": 1, "area_fraction": 0.50},
                      "box": {"side": "22.4 mm"}})"},
      {"two species", R"({"rods": {"area_fraction": 0.40}, "rods_2": {"length": "2.5 mm", "area_fraction": 0.20}})"},
      {"polar rods", R"({"rods": {"profile": "polar", "area_fraction": 0.60}})"},
      {"polar, annulus", R"({"rods": {"profile": "polar", "area_fraction": null, "count": 175},
                             "walls": {"arena": "annulus", "inner": "15 mm"}})"},
      {"disc", R"({"rods": {"area_fraction": 0.60}, "walls": {"arena": "disc"}})"},
      {"at instant", R"({"time": {"impacts": "at_instant"}})"},
      {"poisson", R"({"contacts": {"law": "poisson"}})"},
      {"energetic", R"({"contacts": {"law": "energetic"}})"},
      {"no friction", R"({"contacts": {"rod_rod": {"friction": 0}, "rod_base": {"friction": 0},
                                       "rod_lid": {"friction": 0}}})"},
      {"noise", R"({"plates": {"noise": 0.1}})"},
      {"shuffled", R"({"contacts": {"order": "shuffled"}})"},
      {"weak plates", R"({"plates": {"gamma": 0.8}, "box": {"side": "20 mm"}})"},
      {"plates at rest", R"({"plates": {"gamma": 0}, "box": {"side": "20 mm"}})"},
  };
  return kinds;
}

Case case_of(const SceneKind& kind, double warm_up) {
  nlohmann::json scene = nlohmann::json::parse(kBaseKind);
  scene.merge_patch(nlohmann::json::parse(kind.patch));
  return case_of(std::move(scene), warm_up, kind.name);
}

}  // namespace shaken::bench
