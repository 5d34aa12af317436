// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "client/paper/run_set.h"

namespace shaken::client {

/// What each sweep took, as its runs tell: number of runs, rods, simulated seconds, CPU-hours; a table of Markdown.
std::string sweep_cost_table(const Library& runs, std::span<const std::string_view> sweeps);

/// Which versions made the runs that are there, how many of them, and when the last of each was finished; a list of
/// Markdown.
std::string origin_text(const Library& runs, std::span<const std::string_view> sweeps);

/// What each figure takes from nothing: the CPU-hours of all sweeps that it is drawn from; a table of Markdown.
std::string figure_cost_table(const Library& runs);

}  // namespace shaken::client
