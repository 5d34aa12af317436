#pragma once

#include <optional>
#include <string>

#include "client/watch/cells.h"

namespace shaken::client {

/// Where things stand on the screen of one run. The first line is the title, the last one the status.
struct WatchLayout {
  Area picture;
  Area legend;   ///< one line under the picture
  Area numbers;  ///< beside the picture, or under it
  friend bool operator==(const WatchLayout&, const WatchLayout&) = default;
};

/// The arrangement, numbers beside or under the rods, in which the picture (a cell is about twice as high as wide)
/// becomes larger. Nothing if the terminal is too small for either.
std::optional<WatchLayout> watch_layout(int columns, int lines);

/// "the rods need a terminal of 60x16 or 40x28; this one has 40x10".
std::string size_note(int columns, int lines);

}  // namespace shaken::client
