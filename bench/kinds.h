#pragma once

#include <vector>

#include "bench/case.h"

namespace shaken::bench {

/// A kind of scene whose speed is compared with that of others.
struct SceneKind {
  const char* name;
  const char* patch;  ///< JSON: what a user would write in place of some keys of the base (a merge patch, RFC 7396)
};

/// What the kinds differ from.
inline constexpr const char* kBaseKind =
    R"({"rods": {"length": "4.5 mm", "area_fraction": 0.75}, "box": {"side": "41.865 mm"}, "time": {"step": "4 us"}})";

/// Every kind; the first is the base itself.
const std::vector<SceneKind>& scene_kinds();
Case case_of(const SceneKind& kind, double warm_up);

}  // namespace shaken::bench
