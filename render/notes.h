#pragma once

#include <filesystem>
#include <string>

#include "base/core/result.h"
#include "render/picture.h"

namespace shaken::render {

/// "Run id: 1f0c...; Seed: 1".
std::string notes_text(const Notes& notes);

/// Text as it stands in an element of XML.
std::string xml_text(const std::string& text);

/// Adds to an SVG file that Cairo has written a <title> and, in a <desc>, the notes; and at its end `elements`, which
/// are drawn over everything (Canvas::svg_words).
Result<void> add_words_to_svg(const std::filesystem::path& file, const std::string& title, const Notes& notes,
                              const std::string& elements);

/// Adds the notes as a comment to a finished GIF file.
Result<void> add_notes_to_gif(const std::filesystem::path& file, const Notes& notes);

}  // namespace shaken::render
