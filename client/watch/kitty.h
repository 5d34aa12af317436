// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "client/watch/rod_image.h"

namespace shaken::client {

/// What draws `image` from the cursor on to the right and down, by the graphics protocol of kitty
/// (https://sw.kovidgoyal.net/kitty/graphics-protocol/), as PNG in pieces. It takes the place of the last one. The
/// cursor stays, and the terminal does not answer.
std::string kitty_text(const RodImage& image);
/// What takes the image away, and frees its memory.
std::string kitty_removal();
/// Asks whether the terminal knows this protocol: it answers "\x1b_Gi=...;OK\x1b\\" if it does.
std::string kitty_query();

}  // namespace shaken::client
