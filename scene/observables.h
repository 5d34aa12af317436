// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/fields.h"

namespace shaken::scene {

/// What an observable takes of a body's axis, which a sphere does not have.
enum class AxisUse {
  kNone,    ///< nothing
  kPartly,  ///< some of its numbers need it: MeasurementKind::of_axis
  kNeeded,  ///< all of it is about axes: it is not measured of spheres
};

/// All that a scene knows of one observable: the block "measure.NAME". What a run makes of it, the adapter
/// run/measure/NAME.cpp says.
struct Observable {
  std::string name;
  std::string doc;            ///< one line, for the reference
  bool is_usual = false;      ///< measured where a scene has no "measure" at all
  std::string periodic = "";  ///< what it takes of a periodic box ("the waves"); empty: nothing
  AxisUse axis = AxisUse::kNone;
  std::string every_doc = "Time between samples.";  ///< of the key `every`
  std::vector<Field> keys = {};                     ///< further keys, by their names in the block
  Field block = {}, every = {};                     ///< follow from the above

  /// Whether it can be measured within side walls too.
  bool within_walls() const { return periodic.empty(); }
  /// Whether the plan asks for it, although it is of an axis and the first species, which is measured, has none.
  bool lacks_axis(const RunPlan& plan) const;
  /// The time between samples [s]; none if the plan does not ask for it, or it lacks_axis().
  std::optional<double> period(const RunPlan& plan) const;
  void switch_off(RunPlan& plan) const { block.store(plan, false); }
};

/// All observables, in the order of their keys in a canonical scene.
const std::vector<Observable>& observables();
/// The one of this name, which must exist.
const Observable& observable(std::string_view name);

}  // namespace shaken::scene
