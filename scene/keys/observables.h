#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/keys/fields.h"

namespace shaken::scene {

/// What an observable takes of a body's axis, which a sphere does not have.
enum class AxisUse {
  kNone,    ///< nothing
  kPartly,  ///< some of its numbers need it: Output::needs_axis
  kNeeded,  ///< all of it is about axes: it is not measured of spheres
};

/// The bytes of one measurement.
struct MeasureMemory {
  double state = 0;    ///< what it has gathered at the end of the run; all of it goes into each checkpoint
  double scratch = 0;  ///< what it needs besides while it takes a sample
  double file = 0;     ///< what it adds to observables.h5 beyond what a few samples make of it
  double spare = 0;    ///< what it holds besides at some time before the end, or in arrays that are not full
};

/// What the memory of a measurement follows from.
struct Sizes {
  const RunPlan& plan;   ///< of the rods that are measured
  double samples = 0;    ///< of this measurement in the whole run
  double rods = 0;       ///< that are measured
  double stretches = 0;  ///< of time that sums are kept for; neighbours are merged now and then
};

/// What a measurement against lags keeps.
struct PerLag {
  int columns = 0;  ///< numbers of each rod, of samples for lags to come
  int sums = 0;     ///< of each lag and stretch of time
};

/// All that a scene knows of one observable: the block "measure.NAME". What a run makes of it, the adapter
/// run/measure/NAME.cpp says.
struct Observable {
  std::string name = {};       ///< that of the list (scene/keys/measure_plan.h)
  std::string doc;             ///< one line, for the reference
  bool is_usual = false;       ///< measured where a scene has no "measure" at all
  std::string periodic = "";   ///< what it takes of a periodic box ("the waves"); empty: nothing
  std::string open = "";       ///< what it takes of a plane without posts ("lines of sight"); empty: nothing
  bool is_of_squares = false;  ///< of a periodic box it takes that it is square
  AxisUse axis = AxisUse::kNone;
  std::string every_doc = "Time between samples.";  ///< of the key `every`
  std::vector<Field> keys = {};                     ///< further keys, by their names in the block
  // What it keeps, if that can be more than 2 MB:
  int series = 0;                            ///< columns of a BoundedSeries, that of times among them
  int angles = 0;                            ///< pairs of them, as cosine and sine, that the file holds as one angle
  double (*sums)(const RunPlan&) = nullptr;  ///< numbers that are kept for each stretch of time
  PerLag lags = {};
  double per_rod = 0;                                  ///< bytes
  MeasureMemory (*memory)(const Sizes&) = nullptr;     ///< all else
  std::string remedy = "nothing but to leave it out";  ///< what makes it smaller
  Field block = {}, every = {};                        ///< follow from the above

  /// Whether it can be measured within side walls too.
  bool within_walls() const { return periodic.empty(); }
  /// Whether it can be measured among posts too.
  bool among_posts() const { return periodic.empty() && open.empty(); }
  /// Whether the plan asks for it, although it is of an axis and the first species, which is measured, has none.
  bool lacks_axis(const RunPlan& plan) const;
  /// The time between samples [s]; none if the plan does not ask for it, or it lacks_axis().
  std::optional<double> period(const RunPlan& plan) const;
  /// Whether samples, of a plan that asks for them, are spread over their intervals: at all phases of the vibration.
  bool is_spread(const RunPlan& plan) const;
  void switch_off(RunPlan& plan) const { block.store(plan, false); }
};

/// All observables, in the order of their list (scene/keys/measure_plan.h).
const std::vector<Observable>& observables();
/// The one of this name, which must exist.
const Observable& observable(std::string_view name);

/// The memory of everything that the plan measures, by name. Within a factor of two of what is held, wherever that is
/// more than 2 MB; where it depends on what the rods do (`defects.list`), that of disordered rods, which have the most
/// defects.
std::map<std::string, MeasureMemory> measure_memory(const RunPlan& plan);

/// Bytes that all measurements hold together when they hold most: their states with their spare room, and on top
/// either the copy of the states that a checkpoint is written from, or the scratch of one.
double peak_of(const std::map<std::string, MeasureMemory>& memory);

}  // namespace shaken::scene
