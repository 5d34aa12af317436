// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace shaken::render {

/// The label of a point of a sweep in the words of the field: "rods.area_fraction=0.8 rods.length=2.5" becomes
/// "φ = 0.8, ℓ = 2.5 mm". Words that are not settings of a scene stay as they are.
std::string headline(const std::string& label);

}  // namespace shaken::render
