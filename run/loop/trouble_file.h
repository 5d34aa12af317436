#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/core/result.h"
#include "scene/keys/run_plan.h"
#include "sim/close_up.h"
#include "sim/world.h"

namespace shaken::run {

/// What trouble.json says: how a run met its end, with all that `shaken replay` needs to see it again.
struct TroubleReport {
  NumericalTrouble trouble;
  Tick checkpoint_tick = 0;  ///< of the last sound checkpoint; 0: the beginning
  CloseUp before;            ///< the rods concerned, one tick before
};

/// "numerical trouble at tick 5 (0.000020 s), rods 3, 4: ..."
std::string describe(const NumericalTrouble& trouble, double dt);

/// The rods of a close-up as JSON: units in the names of the fields.
nlohmann::ordered_json to_json(const CloseUp& close_up);

Result<void> write_trouble(const std::filesystem::path& file, const scene::RunPlan& plan, const TroubleReport& report);

/// The trouble and the checkpoint's tick, for a comparison. Fails if the file is not one of write_trouble's.
Result<TroubleReport> read_trouble(const std::filesystem::path& file);

}  // namespace shaken::run
