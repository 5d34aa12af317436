#pragma once

#include <span>
#include <vector>

#include "base/core/result.h"
#include "sim/motion/flight.h"
#include "sim/rod/species.h"
#include "sim/start/director_patterns.h"
#include "sim/system.h"
#include "sim/world.h"

namespace shaken {

/// Flights at tick 0 for every rod of the scene. No two rods and no rod and plate overlap; heights are near the middle
/// of the gap; velocities are Gaussian with 20 mm/s in each direction and 5 rad/s about each axis across the rod.
///
/// kAligned: along x, in rows, every other row shifted by half a rod so that the tapers interlock: without the shift
///           rods of l = 2.5 mm do not fit beyond area fraction 0.7, with it they fit to 0.9. Of all lattices with room
///           for n_rods the roomiest is taken; sites left over are vacancies at random places. Where none has, rows
///           shifted by other parts of a rod are tried, which wind around the periodic box several times. At an angle
///           to x, any lattice that tiles the box will do (TurnedRows).
/// kRandom:  random places and directions one after the other (random sequential insertion); along `directors` if they
///           are given, with the head at either end.
/// Compressed starts are not for this function, nor for make_world(): sim/start/compression.h makes them.
/// Errors:   the rods do not fit; the message names the most that can be placed in rows, or how many had been placed at
///           random when there was no room for another.
/// Several species share one lattice, roomy enough for any two of them side by side. Of an arena, the sites within it
/// are used. In a planar scene (System::is_planar) velocities are planar too.
Result<std::vector<Flight>> initial_flights(const System& system, std::span<const Species> species,
                                            std::span<const std::uint8_t> shape_of_rod,
                                            const DirectorAt& directors = {});

/// The world at tick 0, with the rods placed so. Fails as initial_flights() does.
Result<World> make_world(const System& system);
/// The same of a random start along `directors`.
Result<World> make_world_along(const System& system, const DirectorAt& directors);

}  // namespace shaken
