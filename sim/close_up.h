#pragma once

#include <vector>

#include "sim/motion/flight.h"
#include "sim/motion/plates.h"
#include "sim/world.h"

namespace shaken {

/// A few rods and what is around them at one tick: what numerical trouble is looked at with.
struct CloseUp {
  static constexpr int kBase = -1;  ///< in place of a rod
  static constexpr int kLid = -2;   ///< the same
  static constexpr int kWall = -3;  ///< the same
  static constexpr int kPost = -4;  ///< the same

  struct Rod {
    int rod;
    bool concerned;  ///< asked for; the others are its neighbours
    Pose pose;
    Motion motion;
  };
  struct Contact {
    int rod;
    int other;  ///< a rod, kBase, kLid, kWall or kPost
    int bead;
    int other_bead;   ///< of a rod
    double overlap;   ///< [mm]
    double approach;  ///< speed at which the surfaces approach along the normal; negative: they part [mm/s]
  };

  Tick tick = 0;
  PlateState plates;
  std::vector<Rod> rods;          ///< those asked for first, then the neighbours, each ascending
  std::vector<Contact> contacts;  ///< overlaps of those asked for
  std::vector<int> unknown;       ///< asked for, but their flight began after `tick`
};

/// "base", "lid" or "side wall".
const char* surface_name(int other);

/// The rods of `concerned` and all that come closer to them than `reach` [mm], as they are or were at `tick`. Their
/// flights must have begun by then; those that have not are left out.
CloseUp look_closely(const World& world, Tick tick, const std::vector<int>& concerned, double reach = 0.3);

}  // namespace shaken
