#pragma once

#include <cstdint>

namespace shaken::client {

/// A colour of a cell: 0xRRGGBB, the terminal's own, or one of the eight that the terminal's theme defines.
using Ink = std::int32_t;
inline constexpr Ink kOwnInk = -1;
/// Of the theme, 0 to 7: black, red, green, yellow, blue, magenta, cyan, white.
constexpr Ink theme_ink(int number) { return -2 - number; }

}  // namespace shaken::client
