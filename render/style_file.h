#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "base/core/result.h"
#include "base/keys/problem.h"
#include "render/style.h"

namespace shaken::render {

/// A style that comes with the program, written as a style file is.
struct Preset {
  const char* name;
  const char* doc;   ///< one line
  const char* text;  ///< JSON
};
std::span<const Preset> presets();

/// Reads a style file: JSON with comments, an object of the keys of style_keys(); "style" names a preset to begin with.
/// What the text does not name stays as `style` has it. All problems at once, each with its line.
keys::Loaded<PictureStyle> load_style(std::string_view text, const std::string& file, PictureStyle style);

/// The style called `name`, a preset or a file, over `style`. An error lists all problems, one a line.
Result<PictureStyle> named_style(const std::string& name, const PictureStyle& style);

/// The JSON Schema (base/keys/schema.h) of what load_style reads.
nlohmann::ordered_json style_schema();

/// All presets as a table in Markdown (docs/pictures.md).
std::string presets_as_markdown();

}  // namespace shaken::render
