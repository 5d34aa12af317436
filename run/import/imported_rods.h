// What files that others have written say of rods, before it is held against a scene.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "base/core/types.h"
#include "base/keys/problem.h"
#include "sim/system.h"

namespace shaken::run {

/// One rod.
struct ImportedRod {
  static constexpr double kResting = std::numeric_limits<double>::quiet_NaN();

  int number = 0;          ///< of its line in a table, from 1; its own in a trajectory, from 0
  std::uint8_t shape = 0;  ///< in the world; of a table, in which rods of a species are alike, that is the species
  Vec3 position = Vec3::Zero();   ///< of the centre; z is the height over the base, kResting: as low as possible [mm]
  Vec3 director = Vec3::UnitX();  ///< unit vector
  Vec3 velocity = Vec3::Zero();   ///< of the centre [mm/s]
  Vec3 angular_velocity = Vec3::Zero();  ///< [rad/s]
};

/// The rods of a table in CSV, whose first line names the columns (docs/files.md). Lines that are empty or begin with #
/// are left out, but for one before a first row of numbers that names columns. `species`: names of the species that
/// there may be; none where that is not known. What is wrong is added to `problems`, with its line; such lines give no
/// rod. What is hardly meant is added to `remarks`.
std::vector<ImportedRod> read_csv_rods(std::string_view text, const std::string& file,
                                       std::span<const std::string> species, std::vector<keys::Problem>& problems,
                                       std::vector<std::string>& remarks);

/// The rods of frame `frame`, from 0, or of the last one, of a trajectory.h5 or trajectory.part of a run of which
/// `system` has the rods, the box and all that stands in it. Heights are those over the base as it was then. Files lack
/// angular velocities, which are 0. Fails with what differs from `system`.
Result<std::vector<ImportedRod>> read_recorded_rods(const std::string& file, std::optional<int> frame,
                                                    const System& system);

}  // namespace shaken::run
