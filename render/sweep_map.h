#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "render/picture.h"

namespace shaken::render {

/// A sweep, and where the runs that are drawn are in it.
struct SweepPlaces {
  std::shared_ptr<const SweepMap> map;
  std::vector<Vec2> here;  ///< of each run
};

/// From {"x": "rods.area_fraction", "y": "rods.length", "points": [[0.45, 2.5, 0.12], ...], "here": [[0.45, 2.5],
/// ...]}: of each point the two parameters and S, null where it is not known; "y" is empty and null if there is one
/// parameter.
Result<SweepPlaces> sweep_places(const std::string& json, std::size_t n_runs);

}  // namespace shaken::render
