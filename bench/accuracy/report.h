// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/accuracy/convergence.h"
#include "bench/accuracy/order_error.h"
#include "bench/accuracy/statistics.h"

namespace shaken::bench {

/// The first line of every report: version and machine.
std::string accuracy_heading();
/// What every JSON report begins with; rows are to be added.
nlohmann::ordered_json accuracy_head(const char* part);

/// Each part as text for people, JSON (and from it CSV) for programs, and as pictures.
std::string as_text(const std::vector<Convergence>& measured);
nlohmann::ordered_json as_json(const std::vector<Convergence>& measured);
void draw_convergence(const std::filesystem::path& folder, const std::vector<Convergence>& measured);

std::string as_text(const std::vector<Statistics>& measured);
nlohmann::ordered_json as_json(const std::vector<Statistics>& measured);
void draw_statistics(const std::filesystem::path& folder, const std::vector<Statistics>& measured);

std::string as_text(const std::vector<OrderError>& measured, const std::optional<Extrapolation>& large);
nlohmann::ordered_json as_json(const std::vector<OrderError>& measured, const std::optional<Extrapolation>& large);
void draw_order_error(const std::filesystem::path& folder, const std::vector<OrderError>& measured);

}  // namespace shaken::bench
