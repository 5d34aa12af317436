#pragma once

#include <string>
#include <vector>

#include "base/core/result.h"
#include "sim/motion/flight.h"
#include "sim/system.h"
#include "sim/world.h"

namespace shaken {

/// The world at tick 0 with its rods where, and as fast as, they are in `left` at its tick: what a run begins with that
/// goes on from another under other conditions. Heights are kept as those over the base. Rods of several species keep
/// theirs, in their order; which numbers they have follows from the seed, as at any start. With another seed than that
/// of `left` each component of a velocity is changed by a part in 10^6 or so, at random: the paths of the
/// rods then part after some tens of collisions, while order and defects are shared until they are forgotten.
/// Errors: those of check_left(). Box and gap are those of `left`: sim/start/compression.h changes them.
Result<World> make_world(const System& system, const World& left);

/// What keeps a run of `system` from beginning where one of `other` has left its rods, as "their number, the walls";
/// empty if nothing does. The side of the box and the gap may differ, but not with walls or posts.
std::string start_mismatch(const System& system, const System& other);

/// Whether the box or the gap is another.
bool is_resized(const System& system, const System& other);

/// How far the plates of a run of `system` are from the beginning of a vibration after so many ticks: positive where
/// they are past it, 0 where nothing moves [s]. Only a run that ends within half a tick of one can be gone on from.
double off_the_beat(const System& system, Tick tick);

/// Where a run that is off the beat should end, in words.
std::string nearest_beat(const System& system, Tick tick);

/// Whether a run of `system` can begin where the rods of `left` are now. Errors: start_mismatch(); or the plates of
/// `left` are in the middle of a vibration, so that they would jump.
Result<void> check_left(const System& system, const World& left);

/// Where the rods of `left` are at its tick [mm], and how they move.
struct RodsLeft {
  std::vector<Pose> poses;      ///< (n_rods)
  std::vector<Motion> motions;  ///< (n_rods)
};
/// In the order in which `world` has rods of their species.
RodsLeft rods_left(const World& world, const World& left);

}  // namespace shaken
