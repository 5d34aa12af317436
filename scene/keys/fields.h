#pragma once

#include <string_view>

#include "base/keys/table.h"
#include "scene/keys/keys.h"
#include "scene/keys/run_plan.h"

namespace shaken::scene {

/// A key of a scene.
using Field = keys::Key<RunPlan>;

/// Every key of a scene.
const keys::Table<RunPlan>& fields();

/// The index of the field at `path`; -1 if there is none.
inline int field_index(std::string_view path) { return fields().index(path); }
/// The field at `path`, which must exist.
inline const Field& field_at(std::string_view path) { return fields().at(path); }

/// The time from one sample, or frame, to the next.
auto every(const std::string& path, auto access, const std::string& doc) {
  return quantity(path, access, Dimension::kTime, 1e-7, 1e5, doc);
}

}  // namespace shaken::scene
