#pragma once

#include "sim/cell.h"
#include "sim/snapshot.h"

namespace shaken::render {

/// The rods at a time between two recorded frames of one run, for films that are slower than the recording: centres go
/// straight from one place to the other, across borders too, and axes turn the shorter way; rods that are the same fore
/// and aft by less than a right angle. A rod that comes farther than its length in between, or turns by more than 60
/// degrees, has been hit too often for that: it stays as the nearer frame has it.
Snapshot between(const Snapshot& before, const Snapshot& after, double time, const Cell& cell);

}  // namespace shaken::render
