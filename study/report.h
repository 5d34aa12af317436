// SPDX-License-Identifier: MIT
// What is written about the runs: claims, costs and versions, as tables of Markdown.
#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "study/claims.h"
#include "study/run_set.h"

namespace shaken::study {

/// What each sweep took, as its runs tell: number of runs, rods, simulated seconds, CPU-hours; a table of Markdown.
std::string sweep_cost_table(const Library& runs, std::span<const std::string_view> sweeps);

/// Which versions made the runs that are there, how many of them, and when the last of each was finished; a list of
/// Markdown.
std::string origin_text(const Library& runs, std::span<const std::string_view> sweeps);

/// Those versions.
std::set<std::string> versions_of(const Library& runs, std::span<const std::string_view> sweeps);

/// What each figure takes from nothing: the CPU-hours of all sweeps that it is drawn from; a table of Markdown.
std::string figure_cost_table(const Library& runs);

/// Puts `table` between the lines "<!-- NAME: begin -->" and "<!-- NAME: end -->" of `document`; throws Failure if it
/// lacks them.
std::string with_section(const std::string& document, const std::string& name, const std::string& table);

/// The text of `file` with these sections in place of those that it has, each {name, table}. Throws Failure
/// (kBadInput) with all that it lacks.
std::string with_sections(const std::filesystem::path& file,
                          const std::vector<std::pair<std::string, std::string>>& sections);

/// The sections of a report on everything: origin, claims, sweeps, figures. `runs` by sweep, as they were run.
std::vector<std::pair<std::string, std::string>> report_sections(const Library& runs);

}  // namespace shaken::study
