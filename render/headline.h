// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace shaken::render {

/// The label of a point of a sweep in the words of the field: "rods.area_fraction=0.8 rods.length=2.5" becomes
/// "φ = 0.8, ℓ = 2.5 mm". Words that are not settings of a scene stay as they are.
std::string headline(const std::string& label);

/// What a key of a scene is called where it is swept: "ℓ" of "rods.length"; its last word if it has no symbol.
std::string symbol_of(const std::string& path);

}  // namespace shaken::render
