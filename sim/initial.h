// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "base/core/result.h"
#include "base/core/rng.h"
#include "sim/director_patterns.h"
#include "sim/motion/flight.h"
#include "sim/rod/species.h"
#include "sim/system.h"
#include "sim/world.h"

namespace shaken {

/// Standard deviation of each velocity component at the start [mm/s].
inline constexpr double kStartSpeed = 20.0;

/// Flights at tick 0 for every rod of the scene. No two rods and no rod and plate overlap; heights are near the middle
/// of the gap; velocities are Gaussian with 20 mm/s in each direction and 5 rad/s about each axis across the rod.
///
/// kAligned: along x, in rows, every other row shifted by half a rod so that the tapers interlock: without the shift
///           rods of l = 2.5 mm do not fit beyond area fraction 0.7, with it they fit to 0.9. Of all lattices with room
///           for n_rods the roomiest is taken; sites left over are vacancies at random places. Where none has, rows
///           shifted by other parts of a rod are tried, which wind around the periodic box several times. At an angle
///           to x, any lattice that tiles the box will do (sim/turned_rows.h).
/// kRandom:  random places and directions one after the other (random sequential insertion); along `directors` if they
///           are given, with the head at either end.
/// Compressed starts are not for this function, nor for make_world(): sim/compression.h makes them.
/// Errors:   the rods do not fit; the message names the most that can be placed in rows, or how many had been placed at
///           random when there was no room for another.
/// Several species share one lattice, roomy enough for any two of them side by side. Of an arena, the sites within it
/// are used. In a planar scene (System::is_planar) velocities are planar too.
Result<std::vector<Flight>> initial_flights(const System& system, std::span<const Species> species,
                                            std::span<const std::uint8_t> shape_of_rod,
                                            const DirectorAt& directors = {});

/// Gives a rod whose place and direction are set the random motion of a start, and prepares its flight.
void push_at_start(Flight& flight, const System& system, Rng& rng);

/// The world at tick 0, with the rods placed so. Fails as initial_flights() does.
Result<World> make_world(const System& system);
/// The same of a random start along `directors`.
Result<World> make_world_along(const System& system, const DirectorAt& directors);

/// The world at tick 0 with its rods where, and as fast as, they are in `left` at its tick: what a run begins with that
/// goes on from another under other conditions. Heights are kept as those over the base. Rods of several species keep
/// theirs, in their order; which numbers they have follows from the seed, as at any start. With another seed than that
/// of `left` each component of a velocity is changed by a part in 10^6 or so, at random: the paths of the
/// rods then part after some tens of collisions, while order and defects are shared until they are forgotten.
/// Errors: those of check_left(). Box and gap are those of `left`: sim/compression.h changes them.
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
