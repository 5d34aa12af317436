// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/accuracy/convergence.h"

namespace shaken::bench {

/// The first line of every report: version and machine.
std::string accuracy_heading();
/// What every JSON report begins with; rows are to be added.
nlohmann::ordered_json accuracy_head(const char* part);

/// Each part as text for people, JSON (and from it CSV) for programs, and as pictures.
std::string as_text(const std::vector<Convergence>& measured);
nlohmann::ordered_json as_json(const std::vector<Convergence>& measured);
void draw_convergence(const std::filesystem::path& folder, const std::vector<Convergence>& measured);

}  // namespace shaken::bench
