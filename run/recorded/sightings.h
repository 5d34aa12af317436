#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/types.h"
#include "run/recorded/track_table.h"

namespace shaken::run {

/// One rod in one frame.
struct Sighting {
  double id = 0;                 ///< none twice in a table that has no ids
  Vec3 position = Vec3::Zero();  ///< in the box of the plan; outside of a periodic one where it was
  Vec3 director = Vec3::UnitX();
  std::uint8_t species = 0;
};

/// What a table of tracked rods says, row by row.
struct Sightings {
  std::set<std::string> columns;                   ///< that it has, by our names for them
  std::map<double, std::vector<Sighting>> frames;  ///< by number, or by time
  std::map<double, double> time_of;                ///< of frames [s]
  std::map<double, std::set<double>> seen;         ///< in which frames a rod is, by its id
  bool heads_are_told = true;                      ///< of every species that has axes (HeadsSeen)
  std::vector<std::string> remarks;

  bool has(const std::string& column) const { return columns.contains(column); }
};

/// Reads the rows of such a table; for the arguments see read_tracks().
std::optional<Sightings> read_sightings(std::string_view text, const std::string& file, const scene::RunPlan& plan,
                                        const TrackConventions& conventions, std::vector<keys::Problem>& problems);

}  // namespace shaken::run
