#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "render/picture.h"

namespace shaken::render {

/// The label of a point of a sweep in the words of the field: "rods.area_fraction=0.8 rods.length=2.5" becomes
/// "φ = 0.8, ℓ = 2.5 mm". Words that are not settings of a scene stay as they are.
std::string headline(const std::string& label);

/// What identifies a run by its rods and its box: length, packing, number, gap, size of the box or of the arena.
Notes settings_of(const RodPicture& picture);

/// Gives runs that are shown together their headlines: of one run what identifies it, with the rest as its subtitle; of
/// several the settings that differ between them, or their numbers if none does.
void name_runs(const std::vector<Captions*>& runs);

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
