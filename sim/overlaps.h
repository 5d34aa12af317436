#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/motion/flight.h"
#include "sim/world.h"

namespace shaken {

/// Two rods that overlap, or a rod and a surface.
struct Overlap {
  int rod;
  int other;     ///< a rod of a higher number, or a surface as in CloseUp (sim/close_up.h)
  double depth;  ///< of the beads that are deepest in each other [mm]
};

/// Every overlap of rods of these shapes (n_rods) at `poses` (n_rods), whose centres lie in the box, with each other
/// and with base, lid, walls and posts of `world` at its tick: by rod, of one rod the surfaces first. The rods of
/// `world` itself, of which it may have none, are not looked at.
std::vector<Overlap> find_overlaps(const World& world, std::span<const std::uint8_t> shape_of_rod,
                                   std::span<const Pose> poses);

}  // namespace shaken
