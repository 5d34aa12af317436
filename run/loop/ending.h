#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace shaken::run {

/// What a run that is done has to say at its end, from its summary.json: S with its error and whether it came to rest,
/// what it cost, where the files are, and what to type next. Several lines.
std::string describe_ending(const nlohmann::json& summary, const std::filesystem::path& directory);

}  // namespace shaken::run
