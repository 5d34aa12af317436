// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "client/watch/rod_image.h"

namespace shaken::client {

/// What draws `image` on a terminal with sixel graphics (DEC VT340), from the cursor on to the right and down.
std::string sixel_text(const RodImage& image);

}  // namespace shaken::client
