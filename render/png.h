#pragma once

#include <filesystem>

#include "base/core/result.h"
#include "render/image.h"
#include "render/picture.h"

namespace shaken::render {

/// Says what the picture shows: the label as title, the simulated time, and the picture's notes.
Notes picture_texts(const Frame& frame, const Captions& captions);

/// Writes a PNG with `texts` inside, as tEXt where they are ASCII and iTXt (UTF-8) otherwise; the file appears, or
/// replaces an older one, only when it is complete. `dpi`: pixels per inch that it says it has; 0: none.
template <class Channel>
Result<void> write_png(const std::filesystem::path& file, const ImageOf<Channel>& image, const Notes& texts = {},
                       double dpi = 0);

/// The same with opacity, of 8 bits.
Result<void> write_png(const std::filesystem::path& file, const ClearImage& image, const Notes& texts = {},
                       double dpi = 0);

}  // namespace shaken::render
