#pragma once

#include "base/core/rng.h"
#include "sim/motion/flight.h"
#include "sim/system.h"

namespace shaken {

/// Standard deviation of each velocity component at the start [mm/s].
inline constexpr double kStartSpeed = 20.0;

/// Gives a rod whose place and direction are set the random motion of a start, and prepares its flight: Gaussian
/// velocities of kStartSpeed in each direction, and of 5 rad/s about each axis across the rod. In a planar scene
/// (System::is_planar) both are planar.
void push_at_start(Flight& flight, const System& system, Rng& rng);

}  // namespace shaken
