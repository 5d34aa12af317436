#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/core/box.h"
#include "base/core/types.h"

namespace shaken {

/// Every rod at one tick, as plain arrays of shape (n_rods): what observables, files, the bus and pictures read.
struct Snapshot {
  Tick tick = 0;
  double time = 0;                                 ///< tick * dt [s]
  Box box;                                         ///< sides [mm]
  std::vector<Vec3> position;                      ///< centre; x and y in the box, z above the base's rest [mm]
  std::vector<std::array<std::int32_t, 2>> image;  ///< box crossings: unwrapped x = position.x + image[0] * box.x
  std::vector<Vec3> director;                      ///< unit vector along the rod; its sign is a label that stays
  std::vector<Vec3> velocity;                      ///< of the centre [mm/s]
  std::vector<Vec3> angular_velocity;              ///< [rad/s]

  std::size_t n_rods() const { return position.size(); }
  /// The centre of rod `i` without the jumps at the borders of the box [mm].
  Vec3 unwrapped(std::size_t i) const { return position[i] + Vec3(image[i][0] * box.x(), image[i][1] * box.y(), 0); }
};

}  // namespace shaken
