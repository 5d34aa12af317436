#pragma once

#include <filesystem>
#include <string>

#include "base/core/result.h"

namespace shaken {

/// The root directory of the daemon's data: `given`, else $SHAKEN_ROOT, else $XDG_DATA_HOME/shaken, else
/// ~/.local/share/shaken; absolute. Fails where none of them is set.
Result<std::filesystem::path> data_root(const std::string& given = "");

/// The folder of the scenes and sweeps that come with the programs: share/shaken/configs beside the folder of the
/// running program, where it is installed; that of the source tree otherwise.
std::filesystem::path shipped_configs();
/// The same for the files of the page in a browser: share/shaken/page, or web/page of the source tree.
std::filesystem::path shipped_page();
/// The same for the folder of the Python package `shaken`: share/shaken/python, or python of the source tree.
std::filesystem::path shipped_python();

}  // namespace shaken
