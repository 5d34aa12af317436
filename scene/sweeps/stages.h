#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/keys/draft.h"
#include "scene/keys/run_plan.h"
#include "scene/sweeps/factors.h"

namespace shaken::scene {

/// Stages that follow one another: a protocol in time, such as a ramp of the shaking.
class Protocol {
 public:
  explicit Protocol(const std::vector<Stage>& stages) : stages_(stages) {}

  std::size_t size() const { return stages_.size(); }
  /// All that holds in stage k (from 0): what it says itself, and the last that those before it have said.
  std::vector<Axis> settings(std::size_t k) const;
  /// Adds to `parameters` the keys that only other stages name, with the values of `plan`, so that all stages have the
  /// same.
  void name_the_rest(const RunPlan& plan, nlohmann::ordered_json& parameters) const;
  /// Where stage k says something; none if it says nothing.
  std::optional<Place> place(std::size_t k) const;

 private:
  const std::vector<Stage>& stages_;
};

/// Makes of a draft one that begins at the end of a run that is yet to be named.
void begin_where_another_ends(Draft& draft, std::vector<Problem>& problems);

/// Why a run of `plan` cannot begin where one of `former` ends; empty if it can. The same rods, plates and walls must
/// be in both, and the former end with a whole number of vibrations, at a time that is known before.
std::string cannot_follow(const RunPlan& plan, const RunPlan& former);

}  // namespace shaken::scene
