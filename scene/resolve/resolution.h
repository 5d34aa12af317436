#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/keys/fields.h"

namespace shaken::scene {

/// Dotted paths of fields.
using Paths = std::vector<std::string>;

/// A scene that is being resolved: what was said, what has been made of it so far, and what is wrong with it.
struct Resolution {
  const Draft& draft;
  std::vector<Problem>& problems;
  RunPlan plan = {};

  bool given(std::string_view path) const { return draft.find(path) != nullptr; }
  /// The number given at `path`, or its default.
  double number(std::string_view path) const;
  /// No problem was reported with any of these when they were read.
  bool ok(const Paths& paths) const;

  /// Reports a problem of several fields where the first of them that was given stands.
  void report(const Paths& paths, std::string message);
  /// The same, and false: for a function that returns whether all is well.
  bool refuse(const Paths& paths, std::string message) {
    report(paths, std::move(message));
    return false;
  }
  /// Reports a problem if what followed from `causes` lies outside of the field's range.
  void check_derived(std::string_view path, const Paths& causes);
};

/// One species that is there, with the name of its group of keys: "rods", "rods_2", ...
struct RodGroup {
  std::string name;
  RodShape& rod;
  int& count;
  std::string path(const char* key) const { return name + "." + key; }
};
std::vector<RodGroup> rod_groups(System& system);

/// Whether a quantity that is given twice is the same, to 1e-6.
bool agree(double a, double b);

/// For messages: "4.5 mm".
std::string length_text(double value);
/// For messages: "10 us".
std::string time_text(double value);

// The steps of resolving, file by file; scene/resolve/resolve.cpp calls them in their order. Each takes up what those
// before it have made of the plan, and reports what is wrong. One that returns a bool returns false where others could
// not build on its part: there was a problem with it, or with the values that it is made of.

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
