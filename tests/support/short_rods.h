#pragma once

#include "sim/system.h"

namespace shaken::test {

/// So many rods of 2.5 mm in a box of `side` [mm]; everything else as in a scene that leaves it out.
inline System short_rods(int n_rods, double side = 12) {
  System system;
  system.rod = {.length = 2.5, .n_beads = 9};
  system.n_rods = n_rods;
  system.box_side = side;
  return system;
}

}  // namespace shaken::test
