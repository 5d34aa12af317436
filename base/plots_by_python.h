// Figures of numbers, which the Python package `shaken.plots` draws.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shaken {

/// $SHAKEN_PYTHON: the interpreter that the user has chosen, with all packages that it finds; empty if there is none.
std::string chosen_python();
/// How a part of the Python package is run, "plots": by the interpreter that was chosen, else by /usr/bin/python3 where
/// it is, else by the python3 of PATH; the latter see neither PYTHONPATH, PYTHONHOME nor packages of the user. Throws
/// Failure (kFailed) where the package is not installed.
std::vector<std::string> python_command(const std::string& module);

/// Runs `python3 -m shaken.plots ARGUMENTS` with `input` on its stdin, and returns the lines that it prints: paths of
/// pictures, one a line, and what it had to leave out. Throws Failure with its words where it draws nothing (kFailed)
/// or cannot draw (kBadInput).
std::vector<std::string> plots_by_python(const std::vector<std::string>& arguments, std::string_view input = {});

}  // namespace shaken
