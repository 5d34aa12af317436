// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "base/core/result.h"
#include "render/picture.h"

namespace shaken::render {

/// "Run id: 1f0c...; Seed: 1".
std::string notes_text(const Notes& notes);

/// Adds a <title> and, in a <desc>, the notes to an SVG file that Cairo has written: both are what the format has for
/// it.
Result<void> add_notes_to_svg(const std::filesystem::path& file, const std::string& title, const Notes& notes);

/// Adds the notes as a comment to a finished GIF file.
Result<void> add_notes_to_gif(const std::filesystem::path& file, const Notes& notes);

}  // namespace shaken::render
