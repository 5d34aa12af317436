#pragma once

#include <string>
#include <vector>

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

/// What a key of a scene is called where it is swept: "ℓ" of "rods.length"; its last word if it has no symbol.
std::string symbol_of(const std::string& path);

}  // namespace shaken::render
