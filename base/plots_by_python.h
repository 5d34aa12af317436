// SPDX-License-Identifier: MIT
// Figures of numbers, which the Python package `shaken.plots` draws.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shaken {

/// The interpreter that draws: $SHAKEN_PYTHON, else /usr/bin/python3 where it is, else the python3 of PATH.
std::string python_interpreter();

/// Runs `python3 -m shaken.plots ARGUMENTS` with `input` on its stdin, and returns the lines that it prints: paths of
/// pictures, one a line, and what it had to leave out. Throws Failure with its words where it draws nothing (kFailed)
/// or cannot draw (kBadInput).
std::vector<std::string> plots_by_python(const std::vector<std::string>& arguments, std::string_view input = {});

}  // namespace shaken
