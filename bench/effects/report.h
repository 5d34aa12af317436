// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/effects/savings.h"
#include "bench/speed/report.h"

namespace shaken::bench {

std::string as_text(const Conditions& conditions, const Case& scene, const std::vector<Saving>& savings);
nlohmann::ordered_json as_json(const Conditions& conditions, const Case& scene, const std::vector<Saving>& savings);
void draw_savings(const std::filesystem::path& folder, const std::vector<Saving>& savings);

}  // namespace shaken::bench
