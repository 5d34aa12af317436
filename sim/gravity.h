#pragma once

#include "base/core/types.h"

namespace shaken {

/// The acceleration of what flies, in the frame of the plates. On inclined plates it has a part along them.
struct Gravity {
  double down = 0;            ///< across the plates, towards the base [mm/s^2]
  Vec2 along = Vec2::Zero();  ///< down the slope [mm/s^2]
  bool is_inclined = false;   ///< or else `along` is passed over

  Gravity() = default;
  /// Gravity between level plates.
  Gravity(double down_) : down(down_) {}

  double along_size() const { return is_inclined ? along.norm() : 0.0; }
};

}  // namespace shaken
