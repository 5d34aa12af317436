#pragma once

#include "base/core/types.h"

namespace shaken::analysis {

/// Shortest distance of two segments from `a` to `a` + `along_a` and from `b` to `b` + `along_b` [mm]; either may be a
/// point, and they may be parallel. Source: Ericson, Real-Time Collision Detection (2005), section 5.1.9.
double segment_distance(const Vec3& a, const Vec3& along_a, const Vec3& b, const Vec3& along_b);

}  // namespace shaken::analysis
