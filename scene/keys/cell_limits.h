#pragma once

#include <cstddef>

#include "base/core/result.h"
#include "sim/cell.h"

namespace shaken::scene {

/// Nothing if a scene may have such a cell with `n_rods` rods, and each of these is of a species that has beads; else
/// what is wrong, "a gap of 0 mm; a scene has 0.05 to 100 mm". For cells that come from outside: anybody may send a
/// message, and a file may be damaged. Sizes that no scene has would take any memory and any time.
Result<void> check_cell(const Cell& cell, std::size_t n_rods);

}  // namespace shaken::scene
