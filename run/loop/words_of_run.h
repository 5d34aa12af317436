#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "run/files/progress.h"

namespace shaken::run {

/// "██████····  61.0 %  6.10 of 10 s  0.0123 s/s  ETA 5 min 17 s  S 0.913", without an end of line.
std::string describe_progress(const Progress& progress);

/// Whether a run in this state still goes on.
bool is_under_way(const Progress& progress);

/// What a run that is done has to say at its end, from its summary.json: S with its error and whether it came to rest,
/// what it cost, where the files are, and what to type next. Several lines.
std::string describe_ending(const nlohmann::json& summary, const std::filesystem::path& directory);

}  // namespace shaken::run
