#pragma once

#include <optional>
#include <vector>

#include "sim/start/lattice.h"
#include "sim/start/placement.h"

namespace shaken {

/// The roomiest lattice of rods along x with a usable site for every rod: rows of which every other one is shifted by
/// half a column; where none has room, rows that are shifted by another part of a column, which wind around the
/// periodic box several times. None if the rods do not fit.
std::optional<Lattice> rows_along_x(const Placement& rods);

/// The most rods for which rows_along_x() finds a lattice.
int most_in_rows_along_x(const Placement& rods);

/// Sites at which any rod is clear of side walls and posts, whichever way it lies along x.
std::vector<int> usable_sites(const Lattice& lattice, const Placement& rods);

}  // namespace shaken
