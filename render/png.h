// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "render/image.h"
#include "render/picture.h"
#include "sim/core/result.h"

namespace shaken::render {

/// Key and value of a note inside the file, "Title" or "Software" for example.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// Says what the picture shows: software, label as title, simulated time.
PngTexts picture_texts(const RodPicture& picture);

/// Writes a PNG; the file appears, or replaces an older one, only when it is complete.
Result<void> write_png(const std::filesystem::path& file, const Image& image, const PngTexts& texts = {});

}  // namespace shaken::render
