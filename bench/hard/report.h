// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/hard/outcome.h"

namespace shaken::bench {

std::string as_text(const std::vector<HardCase>& cases);
nlohmann::ordered_json as_json(const std::vector<HardCase>& cases);
/// NAME.png: the smallest margin of each case.
void draw_margins(const std::filesystem::path& folder, const std::vector<HardCase>& cases);

}  // namespace shaken::bench
