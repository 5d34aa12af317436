#include "render/style_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "base/files.h"
#include "base/keys/markdown.h"
#include "base/keys/nearest.h"
#include "base/keys/schema.h"
#include "render/style_keys.h"

namespace shaken::render {
namespace {

const Preset kPresets[] = {
    {"layers", "rods by their angle to the director, whatever the order: the layered phase",
     R"({ "colour": "layers", "defects": false }
)"},
    {"defects", "defects with their tracks, over pale rods and the local order",
     R"({
  "colour": "angle",
  "rods": 0.6,
  "background": "order",   // dark where there is no order: in the cores
  "defects": true,
  "tracks": 2
}
)"},
    {"director", "no rods: streamlines of the director field and its defects over the local order",
     R"({ "rods": 0, "background": "order", "lines": "streamlines", "defects": true }
)"},
    {"tilt", "which end of each rod is raised", R"({ "colour": "tilt", "defects": false }
)"},
    {"mechanism", "a look into the gap in slow motion: rods, plates, and which way each rod moves along itself",
     R"({ "view": "gap", "colour": "speed", "defects": false, "speed": 0.01, "size": [1280, 720] }
)"},
    {"mixture", "several species, told apart by colours that the colour-blind tell apart too",
     R"({ "colour": "species", "defects": false }
)"},
};

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  return names;
}

const Preset* find_preset(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(kPresets), std::end(kPresets), [&](const Preset& preset) { return name == preset.name; });
  return found == std::end(kPresets) ? nullptr : found;
}

}  // namespace

std::span<const Preset> presets() { return kPresets; }

keys::Loaded<PictureStyle> load_style(std::string_view text, const std::string& file, PictureStyle style) {
  keys::Loaded<PictureStyle> loaded = style_keys().read(text, file, std::move(style));
  if (!loaded) return loaded;
  if (auto done = check(*loaded); !done) return std::vector{keys::Problem{file, 0, 0, "", done.error().message}};
  return loaded;
}

Result<PictureStyle> named_style(const std::string& name, const PictureStyle& style) {
  if (const Preset* preset = find_preset(name)) return *load_style(preset->text, preset->name, style);
  std::error_code ignored;
  if (!std::filesystem::exists(name, ignored)) {
    return Error{fmt::format("there is no style '{}': give one of {}, or a file{}", name,
                             fmt::join(preset_names(), ", "), keys::did_you_mean(keys::nearest(name, preset_names())))};
  }
  keys::Loaded<PictureStyle> loaded = load_style(SHAKEN_TRY(read_input(name)), name, style);
  if (!loaded) return Error{to_string(loaded.error())};
  return *loaded;
}

nlohmann::ordered_json style_schema() { return keys::document_schema("Style of pictures of Shaken", style_keys()); }

std::string presets_as_markdown() {
  std::string table = keys::table_head({"`--style`", "what it shows"});
  for (const Preset& preset : kPresets) table += keys::table_line({fmt::format("`{}`", preset.name), preset.doc});
  return table;
}

}  // namespace shaken::render
