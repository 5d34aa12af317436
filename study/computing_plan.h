// SPDX-License-Identifier: MIT
// What is handed to a computing centre: what the runs of a study ask for, and the sweeps themselves.
#pragma once

#include <filesystem>
#include <string>

#include "study/cost.h"
#include "study/selection.h"

namespace shaken::study {

/// Where the sweeps of the plan `file` lie, beside it: FILE without its ending, and "-sweeps".
std::filesystem::path sweeps_beside(const std::filesystem::path& file);

/// The plan as a page of Markdown; `command`: what draws the figures when the runs are done; `sweeps`: the folder of
/// the sweeps as it is named there.
std::string computing_plan(const Selection& selection, const StudyCost& cost, const std::string& command,
                           const std::string& sweeps);

/// Writes the plan, and each sweep that is needed into the folder beside it. Throws Failure if the disk refuses.
void write_computing_plan(const Selection& selection, const StudyCost& cost, const std::string& command,
                          const std::filesystem::path& file);

}  // namespace shaken::study
