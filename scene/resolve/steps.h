#pragma once

#include "scene/resolve/resolution.h"

/// The steps of resolving, file by file; scene/resolve/resolve.cpp calls them in their order. Each takes up what those
/// before it have made of the plan, and reports what is wrong. One that returns a bool returns false where others could
/// not build on its part: there was a problem with it, or with the values that it is made of.
namespace shaken::scene {

// rod_shapes.cpp

/// The number of beads of every species, and whether they make a rod.
bool resolve_rod_shapes(Resolution& scene);

// shaking.cpp

/// Gamma, amplitude and frequency.
bool resolve_shaking(Resolution& scene);
/// Rods fall out of a cell without a base, if they have weight.
void check_base(Resolution& scene);
/// Side walls and posts do not follow the plates through the plane.
void check_horizontal_vibration(Resolution& scene);
void check_inclination(Resolution& scene);
void check_lid_motion(Resolution& scene);

// contacts.cpp

/// Contacts of species of their own need these species; one that is as for all rods is not kept as their own.
void resolve_contacts(Resolution& scene);

// arena.cpp

/// Arena and box, which must fit into each other. Needs the shapes of the rods.
bool resolve_arena(Resolution& scene);

// posts.cpp

/// Posts stand at given places or at the sites of a lattice, and leave room. Needs the arena.
bool resolve_posts(Resolution& scene);
/// Posts may touch each other and the walls, and no more. Needs the numbers of rods, from which the box may follow.
void check_posts(Resolution& scene);

// packing.cpp; all but the last need the shapes of the rods.

/// Numbers of rods, box and area fractions. Needs the arena and the posts.
void resolve_numbers(Resolution& scene);
/// No rod may meet itself through the periodic border.
void check_box(Resolution& scene);
/// Rods must fit between the plates.
void check_gap(Resolution& scene);

// start_patterns.cpp

/// Domains and defects that rods start along, and the distance of these. Needs the box.
void resolve_start_pattern(Resolution& scene);

// times.cpp

/// The step that a word for accuracy stands for.
void resolve_accuracy(Resolution& scene);
/// The step against the period of the plates.
bool check_step(Resolution& scene);
/// Plates that go deeper into a rod within a tick than any overlap may be: a run must sooner or later meet that. Needs
/// the shapes of the rods and the shaking.
void check_plates_in_a_tick(Resolution& scene);
/// Samples and frames cannot follow each other faster than ticks.
void check_intervals(Resolution& scene);

/// A run goes on until S is accurate only if S is measured, and not less long than `time.measure` says.
void check_until(Resolution& scene);
/// A run that starts from another's state needs to know which, and does not place its rods.
void check_start(Resolution& scene);

// measurements.cpp

/// Defaults of observables that follow from rods and box, and conditions between the keys of one.
void resolve_measurements(Resolution& scene);
/// Observables of a periodic box exclude walls; those and others exclude posts.
void check_surroundings(Resolution& scene);

}  // namespace shaken::scene
