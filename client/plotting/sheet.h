// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/plotting/figure.h"

namespace shaken::client {

/// Several plots on one page, row by row: a figure of a paper with its panels.
struct Sheet {
  std::string name{};  ///< of the files: NAME.png, NAME.dat, NAME.gp
  std::string title{};
  int columns = 2;
  std::vector<Figure> panels{};  ///< their names are not used
};

/// Writes NAME.dat, NAME.gp and NAME.png into `folder`, as draw(Figure) does; pictures of panels are copied beside
/// them. Returns the path of NAME.png.
std::filesystem::path draw(const Sheet& sheet, const std::filesystem::path& folder);

}  // namespace shaken::client
