// SPDX-License-Identifier: MIT
#include "scene/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "scene/accuracy.h"
#include "scene/derived.h"
#include "scene/nearest.h"
#include "sim/core/check.h"

namespace shaken::scene {

namespace {

/// Reads and writes the number that `access` points at.
template <class Access>
Field number(std::string path, Form form, Dimension dimension, double low, double high, std::string doc,
             Access access) {
  using Number = std::remove_cvref_t<decltype(access(std::declval<RunPlan&>()))>;
  Field field;
  field.path = std::move(path);
  field.form = form;
  field.dimension = dimension;
  field.low = low;
  field.high = high;
  field.doc = std::move(doc);
  field.fetch = [access](const RunPlan& plan) { return Value(static_cast<double>(access(plan))); };
  field.store = [access](RunPlan& plan, const Value& value) {
    access(plan) = static_cast<Number>(std::get<double>(value));
  };
  return field;
}

template <class Access>
Field quantity(std::string path, Dimension dimension, double low, double high, std::string doc, Access access) {
  return number(std::move(path), Form::kQuantity, dimension, low, high, std::move(doc), access);
}

template <class Access>
Field whole(std::string path, double low, double high, std::string doc, Access access) {
  return number(std::move(path), Form::kWhole, Dimension::kPlain, low, high, std::move(doc), access);
}

/// The entry of a short table for which `is_it` holds; there must be one.
template <class Table, class Predicate>
const auto& entry(const Table& table, Predicate is_it) {
  const auto found = std::find_if(table.begin(), table.end(), is_it);
  SHAKEN_CHECK(found != table.end(), "a name without value or a value without name");
  return *found;
}

template <class Enum, class Access>
Field choice(std::string path, std::vector<std::pair<std::string, Enum>> choices, std::string doc, Access access) {
  Field field;
  field.path = std::move(path);
  field.form = Form::kName;
  field.doc = std::move(doc);
  for (const auto& [name, value] : choices) field.names.push_back(name);
  field.fetch = [access, choices](const RunPlan& plan) {
    return Value(entry(choices, [&](const auto& choice) { return choice.second == access(plan); }).first);
  };
  field.store = [access, choices](RunPlan& plan, const Value& name) {
    access(plan) =
        entry(choices, [&](const auto& choice) { return choice.first == std::get<std::string>(name); }).second;
  };
  return field;
}

template <class Block>
Field block(std::string path, bool on, std::string doc, std::optional<Block> RunPlan::*member) {
  Field field;
  field.path = std::move(path);
  field.form = Form::kBlock;
  field.doc = std::move(doc);
  field.fallback = on;
  field.fetch = [member](const RunPlan& plan) { return Value((plan.*member).has_value()); };
  field.store = [member](RunPlan& plan, const Value& is_on) {
    (plan.*member).reset();
    if (std::get<bool>(is_on)) (plan.*member).emplace();
  };
  return field;
}

Field every(std::string path, std::string doc, auto access) {
  return quantity(std::move(path), Dimension::kTime, 1e-7, 1e5, std::move(doc), access);
}

/// Shown so that 7 stays 7 after a way through amplitude and frequency.
double to_ten_digits(double value) { return parse_decimal(fmt::format("{:.10g}", value)).value().value(); }

/// A field whose value follows from others unless it is given.
Field derived(Field field, std::string note) {
  field.fallback_note = std::move(note);
  return field;
}

/// A field that is given in place of another: it has no place in a plan.
Field instead(std::string path, Dimension dimension, double low, double high, double fallback, std::string doc,
              std::function<Value(const RunPlan&)> fetch) {
  Field field;
  field.path = std::move(path);
  field.dimension = dimension;
  field.low = low;
  field.high = high;
  field.fallback = fallback;
  field.doc = std::move(doc);
  field.fetch = std::move(fetch);
  return field;
}

/// A key that came later: left out where it says what held before there was a choice.
Field later(Field field) {
  field.omit_if_default = true;
  return field;
}

template <class Access>
Field on_or_off(std::string path, std::string doc, Access access) {
  Field field;
  field.path = std::move(path);
  field.form = Form::kSwitch;
  field.doc = std::move(doc);
  field.fetch = [access](const RunPlan& plan) { return Value(access(plan)); };
  field.store = [access](RunPlan& plan, const Value& on) { access(plan) = std::get<bool>(on); };
  return field;
}

/// A block that is an optional of the system.
template <class Access>
Field system_block(std::string path, std::string doc, Access access) {
  Field field;
  field.path = std::move(path);
  field.form = Form::kBlock;
  field.doc = std::move(doc);
  field.fallback = false;
  field.fetch = [access](const RunPlan& plan) { return Value(access(plan).has_value()); };
  field.store = [access](RunPlan& plan, const Value& is_on) {
    access(plan).reset();
    if (std::get<bool>(is_on)) access(plan).emplace();
  };
  return field;
}

Field steady_field() {
  Field field;
  field.path = "time.steady";
  field.dimension = Dimension::kTime;
  field.low = 0;
  field.high = 1e7;
  field.names = {"auto"};
  field.doc = "Time before measuring begins. \"auto\": found from S(t) afterwards.";
  field.fetch = [](const RunPlan& plan) { return plan.steady ? Value(*plan.steady) : Value("auto"); };
  field.store = [](RunPlan& plan, const Value& value) {
    plan.steady.reset();
    if (const double* time = std::get_if<double>(&value)) plan.steady = *time;
  };
  return field;
}

/// A word for what other keys say in numbers.
Field accuracy_field() {
  Field field;
  field.path = "accuracy";
  field.form = Form::kName;
  std::string steps;
  for (const AccuracyLevel& level : accuracy_levels()) {
    field.names.emplace_back(level.name);
    steps +=
        fmt::format("{}{} {}", steps.empty() ? "" : ", ", level.name, format_quantity(level.step, Dimension::kTime));
  }
  field.fallback_note = "none";
  field.doc = fmt::format("A word in place of `time.step`: {}.", steps);
  return field;
}

Field movie_size_field() {
  Field field;
  field.path = "movie.size";
  field.form = Form::kSize;
  field.low = 64;
  field.high = 7680;
  field.doc = "Width and height in pixels; even numbers.";
  field.fetch = [](const RunPlan& plan) {
    return Value(
        std::array<double, 2>{static_cast<double>(plan.movie->width), static_cast<double>(plan.movie->height)});
  };
  field.store = [](RunPlan& plan, const Value& value) {
    const auto& [width, height] = std::get<std::array<double, 2>>(value);
    plan.movie->width = static_cast<int>(width);
    plan.movie->height = static_cast<int>(height);
  };
  return field;
}

/// Friction and restitution of one kind of contact.
void add_contact(std::vector<Field>& table, const std::string& kind, const std::string& what,
                 ContactParameters Scene::*member) {
  table.push_back(quantity(
      "contacts." + kind + ".friction", Dimension::kPlain, 0, 1000,
      "Coulomb's friction coefficient between " + what + ".", [member](auto& p) -> auto& {
        return (p.system.*member).friction;
      }));
  table.push_back(quantity(
      "contacts." + kind + ".restitution", Dimension::kPlain, 0, 1,
      "Coefficient of restitution between " + what + ".", [member](auto& p) -> auto& {
        return (p.system.*member).restitution;
      }));
}

/// One kind of rod. The first has an area fraction by default, the others need a number.
template <class Shape, class Count, class Fraction>
void add_rods(std::vector<Field>& table, const std::string& name, Shape shape, Count count, Fraction fraction,
              bool is_first) {
  using enum Dimension;
  const auto add = [&](const char* key, Field field) {
    field.path = name + "." + key;
    table.push_back(std::move(field));
  };
  add("length", quantity(
                    "", kLength, 0.05, 50, "From tip to tip.", [shape](auto& p) -> auto& { return shape(p).length; }));
  add("mid_diameter",
      quantity(
          "", kLength, 0.05, 20,
          "Of the centre bead; of a polar rod's tail.", [shape](auto& p) -> auto& { return shape(p).mid_diameter; }));
  add("end_diameter",
      quantity(
          "", kLength, 0.05, 20,
          "Of the two end beads; of a polar rod's head.", [shape](auto& p) -> auto& { return shape(p).end_diameter; }));
  add("profile", later(choice<Profile>(
                     "", {{"symmetric", Profile::kSymmetric}, {"polar", Profile::kPolar}},
                     "Thickness falls from the centre to both ends; or from tail to head.", [shape](auto& p) -> auto& {
                       return shape(p).profile;
                     })));
  Field diameters;
  diameters.form = Form::kNumbers;
  diameters.dimension = kLength;
  diameters.low = 0.05;
  diameters.high = 20;
  diameters.doc = "Of each bead from tail to head, in place of a profile.";
  diameters.fallback_note = "none";
  diameters.fetch = [shape](const RunPlan& p) {
    return shape(p).bead_diameters.empty() ? Value() : Value(shape(p).bead_diameters);
  };
  diameters.store = [shape](RunPlan& p, const Value& value) {
    shape(p).bead_diameters = std::get<std::vector<double>>(value);
  };
  add("bead_diameters", std::move(diameters));
  add("bead_pitch", instead("", kLength, 0.01, 10, kDefaultBeadPitch,
                            "Largest distance of neighbouring beads; the fewest beads that keep to it are taken.", {}));
  add("beads", derived(whole(
                           "", 1, kMaxBeads,
                           "Number of beads, odd, in place of bead_pitch; 1 is a sphere of diameter mid_diameter.",
                           [shape](auto& p) -> auto& { return shape(p).n_beads; }),
                       "from bead_pitch"));
  add("density",
      quantity(
          "", kDensity, 0.001, 100,
          is_first ? "Of the material. Sets the unit of energy only." : "Of the material.", [shape](auto& p) -> auto& {
            return shape(p).density;
          }));
  Field area = instead("", kPlain, 1e-6, kMaxAreaFractionAligned, kDefaultAreaFraction,
                       is_first ? "Area of all rods, lying flat, per area of the box (or arena)."
                                : "Area of these rods, lying flat, per area of the box (or arena).",
                       [fraction](const RunPlan& p) { return Value(to_ten_digits(fraction(p))); });
  if (!is_first) {
    area.fallback = Value();
    area.fallback_note = "from count";
  }
  add("area_fraction", std::move(area));
  add("count", derived(whole(
                           "", 1, 1e6, "Number of rods.", [count](auto& p) -> auto& { return count(p); }),
                       is_first ? "from area_fraction and side" : "from area_fraction"));
}

std::vector<Field> make_table() {
  using enum Dimension;
  std::vector<Field> table;
  const auto add = [&](Field field) { table.push_back(std::move(field)); };

  add_rods(
      table, "rods", [](auto& p) -> auto& { return p.system.rod; }, [](auto& p) -> auto& { return p.system.n_rods; },
      [](const RunPlan& p) { return area_fraction_of(p.system); }, true);
  add(choice<Start>(
      "rods.start", {{"aligned", Start::kAligned}, {"random", Start::kRandom}},
      "Rods in rows along x, every other row shifted by half a rod; or at random (dilute systems).",
      [](auto& p) -> auto& { return p.system.start; }));

  for (std::size_t k = 0; k < 2; ++k) {
    const std::string name = fmt::format("rods_{}", k + 2);
    add(system_block(
        name, "Rods of another kind among the first, at random places.", [k](auto& p) -> auto& {
          return p.system.added[k];
        }));
    add_rods(
        table, name, [k](auto& p) -> auto& { return p.system.added[k]->rod; },
        [k](auto& p) -> auto& { return p.system.added[k]->count; },
        [k](const RunPlan& p) { return area_fraction_of(p.system, p.system.added[k]->rod, p.system.added[k]->count); },
        false);
  }

  add(quantity(
      "box.side", kLength, 1, 2000, "L, of the square box, periodic in x and y.",
      [](auto& p) -> auto& { return p.system.box_side; }));
  add(quantity(
      "box.gap", kLength, 0.05, 100, "w, between base and lid.", [](auto& p) -> auto& { return p.system.gap; }));

  add(instead("plates.gamma", kPlain, 0, 200, kDefaultGamma,
              "Strength of shaking: largest acceleration of the plates over gravity.", [](const RunPlan& p) {
                const std::optional<double> gamma = gamma_of(p.system);
                return gamma ? Value(to_ten_digits(*gamma)) : Value();
              }));
  add(derived(quantity(
                  "plates.amplitude", kLength, 0, 10, "a, of the plates' vibration.",
                  [](auto& p) -> auto& { return p.system.amplitude; }),
              "from gamma and frequency"));
  add(quantity(
      "plates.frequency", kFrequency, 0.1, 1e5, "f, of the plates' vibration.",
      [](auto& p) -> auto& { return p.system.frequency; }));
  Field gravity = quantity(
      "gravity", kAcceleration, 100, 1e5, "g, downwards; 0: weightless, plates then by amplitude and frequency.",
      [](auto& p) -> auto& { return p.system.gravity; });
  gravity.or_zero = true;
  add(std::move(gravity));

  add(later(on_or_off(
      "plates.base", "Whether there is a base.", [](auto& p) -> auto& { return p.system.base; })));
  add(later(on_or_off(
      "plates.lid", "Whether there is a lid.", [](auto& p) -> auto& { return p.system.lid; })));
  add(later(quantity(
      "plates.noise", kPlain, 0, 10,
      "Rotational noise, rad/mm: each hit by a plate changes the rod's angular velocity about the vertical by this "
      "much per speed of the hit, to either side at random.",
      [](auto& p) -> auto& { return p.system.rotational_noise; })));
  add(system_block(
      "walls", "Side walls round an arena in the middle of the box, in place of periodic borders.",
      [](auto& p) -> auto& { return p.system.walls; }));
  add(choice<Arena>(
      "walls.arena", {{"disc", Arena::kDisc}, {"square", Arena::kSquare}, {"annulus", Arena::kAnnulus}}, "Its shape.",
      [](auto& p) -> auto& { return p.system.walls->arena; }));
  add(derived(quantity(
                  "walls.size", kLength, 1, 2000, "Diameter of the disc or of the outer wall, or side of the square.",
                  [](auto& p) -> auto& { return p.system.walls->size; }),
              "as large as box.side allows"));
  Field inner = quantity(
      "walls.inner", kLength, 0.1, 2000, "Diameter of an annulus' inner wall.",
      [](auto& p) -> auto& { return p.system.walls->inner; });
  inner.fallback = SideWalls{}.inner;
  inner.fetch = [](const RunPlan& p) {
    return p.system.walls->arena == Arena::kAnnulus ? Value(p.system.walls->inner) : Value();
  };
  add(std::move(inner));
  add(quantity(
      "walls.friction", kPlain, 0, 1000, "Coulomb's friction coefficient between rod and wall.",
      [](auto& p) -> auto& { return p.system.walls->contact.friction; }));
  add(quantity(
      "walls.restitution", kPlain, 0, 1, "Coefficient of restitution between rod and wall.",
      [](auto& p) -> auto& { return p.system.walls->contact.restitution; }));

  add_contact(table, "rod_rod", "two rods", &Scene::rod_rod);
  add_contact(table, "rod_base", "rod and base", &Scene::rod_base);
  add_contact(table, "rod_lid", "rod and lid", &Scene::rod_lid);
  add(choice<ImpulseLaw>(
      "contacts.law",
      {{"newton", ImpulseLaw::kNewton}, {"poisson", ImpulseLaw::kPoisson}, {"energetic", ImpulseLaw::kEnergetic}},
      "Impulse law: restitution of velocity, of impulse, or of work (docs/stability.md).",
      [](auto& p) -> auto& { return p.system.law; }));
  add(whole(
      "contacts.sweeps", 1, 100, "Passes over the contacts of one tick.",
      [](auto& p) -> auto& { return p.system.solver_sweeps; }));
  Field order = choice<ContactOrder>(
      "contacts.order",
      {{"sorted", ContactOrder::kSorted}, {"reversed", ContactOrder::kReversed}, {"shuffled", ContactOrder::kShuffled}},
      "Order in which the contacts of one tick get their impulses; no statistics should depend on it.",
      [](auto& p) -> auto& { return p.system.order; });
  order.omit_if_default = true;
  add(std::move(order));

  add(accuracy_field());
  add(quantity(
      "time.step", kTime, 1e-7, 1e-4, "The tick: the accuracy knob.", [](auto& p) -> auto& { return p.system.dt; }));
  add(choice<Engine>(
      "time.engine", {{"scheduled", Engine::kScheduled}, {"reference", Engine::kReference}},
      "How the rods are stepped; both give bitwise the same trajectory.",
      [](auto& p) -> auto& { return p.system.engine; }));
  add(later(choice<ImpactTime>(
      "time.impacts", {{"tick_end", ImpactTime::kTickEnd}, {"at_instant", ImpactTime::kAtInstant}},
      "Impacts take place at the end of their tick, as in the paper, or at their own instant within it.",
      [](auto& p) -> auto& { return p.system.impacts; })));
  add(steady_field());
  add(quantity(
      "time.measure", kTime, 1e-6, 1e7, "Length of the run after `steady`.",
      [](auto& p) -> auto& { return p.measure_time; }));
  add(whole(
      "time.seed", 0, 9007199254740992.0, "Of all random numbers. Replica k of a sweep has seed + k - 1.",
      [](auto& p) -> auto& { return p.system.seed; }));

  add(block("measure.order", true, "Nematic order S(t) in the plane.", &RunPlan::order));
  add(every(
      "measure.order.every", "Time between samples.", [](auto& p) -> auto& { return p.order->every; }));
  add(block("measure.angles", false, "Distribution of the angle to the director.", &RunPlan::angles));
  add(every(
      "measure.angles.every", "Time between samples.", [](auto& p) -> auto& { return p.angles->every; }));
  add(whole(
      "measure.angles.bins", 2, 10000, "Over [-pi/2, pi/2).", [](auto& p) -> auto& { return p.angles->bins; }));
  add(block("measure.tilt", false, "Mean velocity along and across the rod against its tilt n_z.", &RunPlan::tilt));
  add(every(
      "measure.tilt.every", "Time between samples.", [](auto& p) -> auto& { return p.tilt->every; }));
  add(whole(
      "measure.tilt.bins", 2, 10000, "From the largest tilt that the gap allows downwards to upwards.",
      [](auto& p) -> auto& { return p.tilt->bins; }));
  add(block("measure.defects", false,
            "Topological defects of the smoothed director field, within walls if there are any, and where there are "
            "rods.",
            &RunPlan::defects));
  add(every(
      "measure.defects.every", "Time between samples.", [](auto& p) -> auto& { return p.defects->every; }));
  add(derived(quantity(
                  "measure.defects.smoothing", kLength, 0.01, 200, "Standard deviation of the Gaussian.",
                  [](auto& p) -> auto& { return p.defects->smoothing; }),
              "half a rod length"));
  add(derived(quantity(
                  "measure.defects.grid", kLength, 0.01, 200, "Width of the mesh.",
                  [](auto& p) -> auto& { return p.defects->grid; }),
              "an eighth of a rod length"));
  add(later(on_or_off(
      "measure.defects.list", "Keep every defect found, with its track. Takes memory in proportion to the run.",
      [](auto& p) -> auto& { return p.defects->list; })));
  add(later(quantity(
      "measure.defects.min_lifetime", kTime, 1e-7, 1e5,
      "Tracks seen for so long are told by themselves as lasting ones: noise makes short-lived pairs.",
      [](auto& p) -> auto& { return p.defects->min_lifetime; })));
  add(block("measure.g2", false,
            "Orientational correlation G2(r) and pair distribution g(r), within walls if there are any.",
            &RunPlan::g2));
  add(every(
      "measure.g2.every", "Time between samples.", [](auto& p) -> auto& { return p.g2->every; }));
  add(whole(
      "measure.g2.bins", 2, 10000, "Over distances from 0 to half the box.",
      [](auto& p) -> auto& { return p.g2->bins; }));
  add(block("measure.msd", false, "Mean square displacement against lag.", &RunPlan::msd));
  add(every(
      "measure.msd.every", "Time between samples: the shortest lag.", [](auto& p) -> auto& { return p.msd->every; }));
  add(block("measure.fluctuations", false,
            "Giant number fluctuations: numbers of rods in boxes of 1/4 to 1/400 of the area.",
            &RunPlan::fluctuations));
  add(every(
      "measure.fluctuations.every", "Time between samples.", [](auto& p) -> auto& { return p.fluctuations->every; }));
  add(block("measure.frank", false,
            "The director's fluctuations against the wave vector, and the ratio of the Frank constants of bend and "
            "splay. Not with walls.",
            &RunPlan::frank));
  add(every(
      "measure.frank.every", "Time between samples.", [](auto& p) -> auto& { return p.frank->every; }));

  add(block("measure.rotation", false, "Rotation in the plane against lag: MSAD and C2(t).", &RunPlan::rotation));
  add(every(
      "measure.rotation.every", "Time between samples: the shortest lag. Rods turn by much less than a quarter turn.",
      [](auto& p) -> auto& { return p.rotation->every; }));
  add(block("measure.velocity", false, "Velocity autocorrelation C_v(t).", &RunPlan::velocity));
  add(every(
      "measure.velocity.every", "Time between samples: the shortest lag.",
      [](auto& p) -> auto& { return p.velocity->every; }));
  add(quantity(
      "measure.velocity.window", kTime, 1e-7, 1e5,
      "Velocities are displacements over this time; rounded to a multiple of `every`.",
      [](auto& p) -> auto& { return p.velocity->window; }));
  add(block("measure.rods", false, "Where single rods go, from the steady time on (from the start if it is \"auto\").",
            &RunPlan::rods));
  add(every(
      "measure.rods.every", "Time between samples.", [](auto& p) -> auto& { return p.rods->every; }));
  add(whole(
      "measure.rods.count", 1, 1000, "Number of rods, spread evenly over their indices.",
      [](auto& p) -> auto& { return p.rods->count; }));
  add(quantity(
      "measure.rods.duration", kTime, 1e-6, 1e7, "How long they are followed.",
      [](auto& p) -> auto& { return p.rods->duration; }));
  add(block("measure.pairs", false,
            "Maps of g(x, y) and G2(x, y) in the frame of the director, and cuts through them. Not with walls.",
            &RunPlan::pairs));
  add(every(
      "measure.pairs.every", "Time between samples.", [](auto& p) -> auto& { return p.pairs->every; }));
  add(whole(
      "measure.pairs.bins", 2, 201,
      "Of the map each way; an odd number has one about 0. A run keeps 64 maps of its stretches of time, 16 bytes a "
      "bin: "
      "41 MB at most.",
      [](auto& p) -> auto& { return p.pairs->bins; }));
  add(derived(quantity(
                  "measure.pairs.range", kLength, 0.01, 1000, "Half the width of the map, at most half the box.",
                  [](auto& p) -> auto& { return p.pairs->range; }),
              "three rod lengths, at most half the box"));
  add(block("measure.layers", false, "Layers along the director: spectrum, wavelength and order. Not with walls.",
            &RunPlan::layers));
  add(every(
      "measure.layers.every", "Time between samples.", [](auto& p) -> auto& { return p.layers->every; }));
  add(block("measure.lattice", false, "Crystals: psi_6 and the largest Bragg peak. Not with walls.",
            &RunPlan::lattice));
  add(every(
      "measure.lattice.every", "Time between samples.", [](auto& p) -> auto& { return p.lattice->every; }));

  add(block("trajectory", false, "Rod positions and directions into trajectory.h5.", &RunPlan::trajectory));
  add(every(
      "trajectory.every", "Time between frames.", [](auto& p) -> auto& { return p.trajectory->every; }));
  add(block("stream", true, "Live state over LCM. Has no influence on results nor on the run's name.",
            &RunPlan::stream));
  add(quantity(
      "stream.rate", kFrequency, 0.1, 100, "Frames per wall-clock second, at most.",
      [](auto& p) -> auto& { return p.stream->rate; }));
  add(block("movie", false, "A movie of the finished run.", &RunPlan::movie));
  add(every(
      "movie.every", "Simulated time between frames.", [](auto& p) -> auto& { return p.movie->every; }));
  add(movie_size_field());

  // The defaults are those of the structs themselves.
  RunPlan defaults;
  for (const Field& field : table) {
    if (field.form == Form::kBlock) field.store(defaults, true);
  }
  for (Field& field : table) {
    const bool open = std::holds_alternative<std::monostate>(field.fallback) && field.fallback_note.empty();
    if (open) field.fallback = field.fetch(defaults);
  }
  return table;
}

/// Everything but the last name of a dotted path.
std::string_view parent_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot);
}

std::string_view last_name(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

}  // namespace

const std::vector<Field>& fields() {
  static const std::vector<Field> table = make_table();
  return table;
}

int field_index(std::string_view path) {
  static const auto index = [] {
    std::unordered_map<std::string_view, int> by_path;
    for (std::size_t i = 0; i < fields().size(); ++i) by_path.emplace(fields()[i].path, static_cast<int>(i));
    return by_path;
  }();
  const auto found = index.find(path);
  return found == index.end() ? -1 : found->second;
}

const Field& field_at(std::string_view path) {
  const int index = field_index(path);
  SHAKEN_CHECK(index >= 0, std::string(path));
  return fields()[static_cast<std::size_t>(index)];
}

bool is_beneath(std::string_view path, std::string_view outer) {
  return outer.empty() || (path.size() > outer.size() && path.starts_with(outer) && path[outer.size()] == '.');
}

bool is_group(std::string_view path) {
  return field_index(path) < 0 && std::any_of(fields().begin(), fields().end(),
                                              [&](const Field& field) { return is_beneath(field.path, path); });
}

std::vector<std::string> names_in(std::string_view path) {
  std::vector<std::string> names;
  for (const Field& field : fields()) {
    if (!is_beneath(field.path, path)) continue;
    const std::string_view rest = std::string_view(field.path).substr(path.empty() ? 0 : path.size() + 1);
    const std::string name(rest.substr(0, rest.find('.')));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::string_view block_around(std::string_view path) {
  for (std::string_view outer = parent_of(path); !outer.empty(); outer = parent_of(outer)) {
    const int index = field_index(outer);
    if (index >= 0) return fields()[static_cast<std::size_t>(index)].path;
  }
  return {};
}

std::string suggest_path(std::string_view path) {
  // A slip in the last name only: what could stand beside it.
  const std::string_view parent = parent_of(path);
  if (parent.empty() || is_group(parent) || field_index(parent) >= 0) {
    const std::string name = nearest(last_name(path), names_in(parent));
    if (!name.empty()) return did_you_mean(parent.empty() ? name : fmt::format("{}.{}", parent, name));
  }
  // The right name in the wrong place, or slips elsewhere.
  std::vector<std::string> paths;
  std::string same_name;
  for (const Field& field : fields()) {
    paths.push_back(field.path);
    if (same_name.empty() && last_name(field.path) == last_name(path)) same_name = field.path;
  }
  const std::string whole_path = nearest(path, paths);
  return did_you_mean(whole_path.empty() ? same_name : whole_path);
}

bool is_allowed(const Field& field, double value) {
  return (value >= field.low && value <= field.high) || (field.or_zero && value == 0);
}

std::string range_of(const Field& field) {
  return (field.or_zero ? "0 or " : "") + format_range(field.low, field.high, field.dimension);
}

std::string show(const Field& field, const Value& value) {
  if (const bool* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const double* number = std::get_if<double>(&value)) return format_quantity(*number, field.dimension);
  if (const std::string* name = std::get_if<std::string>(&value)) return fmt::format("\"{}\"", *name);
  if (const auto* size = std::get_if<std::array<double, 2>>(&value)) {
    return fmt::format("[{}, {}]", (*size)[0], (*size)[1]);
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    std::string text;
    for (const double number : *numbers)
      text += fmt::format("{}{}", text.empty() ? "" : ", ", format_quantity(number, field.dimension));
    return "[" + text + "]";
  }
  return "none";
}

std::string fields_as_markdown() {
  std::string table = "| key | meaning | unit | allowed | default |\n|---|---|---|---|---|\n";
  for (const Field& field : fields()) {
    std::string allowed;
    for (const std::string& name : field.names)
      allowed += fmt::format("{}`\"{}\"`", allowed.empty() ? "" : " or ", name);
    if (field.form == Form::kBlock) {
      allowed = "object or `null`";
    } else if (field.form == Form::kSwitch) {
      allowed = "`true` or `false`";
    } else if (field.form == Form::kNumbers) {
      allowed = "list of " + range_of(field);
    } else if (field.form != Form::kName) {
      const std::string range = field.form == Form::kWhole
                                    ? fmt::format("whole, {:.16g} to {:.16g}", field.low, field.high)
                                    : range_of(field);
      allowed += (allowed.empty() ? "" : " or ") + range;
    }
    const std::string unit(default_unit(field.dimension));
    const std::string fallback = field.fallback_note.empty() ? show(field, field.fallback) : field.fallback_note;
    table += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.path, field.doc, unit, allowed, fallback);
  }
  return table;
}

}  // namespace shaken::scene
