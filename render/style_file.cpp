// SPDX-License-Identifier: MIT
#include "render/style_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "base/files.h"
#include "render/style_keys.h"
#include "scene/document.h"
#include "scene/load.h"
#include "scene/nearest.h"
#include "scene/units.h"

namespace shaken::render {
namespace {

using scene::Node;
using scene::Problem;

constexpr const char* kBase = "style";

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

std::string list_of(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// A number; of a time also a text with a unit.
std::optional<double> number_in(const Node& node, const StyleKey& key) {
  if (node.kind == Node::Kind::kNumber) {
    if (const auto number = scene::parse_quantity(node.text, scene::Dimension::kPlain)) return *number;
  }
  if (node.kind == Node::Kind::kString && std::string_view(key.value_name) == "S") {
    if (const auto number = scene::parse_quantity(node.text, scene::Dimension::kTime)) return *number;
  }
  return std::nullopt;
}

/// The value in the key's form; nothing, with what is wanted in `wanted`, if it is of another.
std::optional<StyleValue> value_in(const Node& node, const StyleKey& key, std::string& wanted) {
  switch (key.form) {
    case StyleForm::kSwitch:
      wanted = "true or false";
      if (node.kind == Node::Kind::kBoolean) return node.boolean;
      return std::nullopt;
    case StyleForm::kWord:
      wanted = "a text";
      if (node.kind == Node::Kind::kString) return node.text;
      return std::nullopt;
    case StyleForm::kNumber:
      wanted = std::string_view(key.value_name) == "S" ? "a number of seconds, or a text like \"500 ms\"" : "a number";
      if (const auto number = number_in(node, key)) return *number;
      return std::nullopt;
    case StyleForm::kPair:
    case StyleForm::kSize:
      break;
  }
  wanted = "two numbers, [a, b]";
  if (node.kind != Node::Kind::kArray || node.items.size() != 2) return std::nullopt;
  const auto first = number_in(node.items[0], key), second = number_in(node.items[1], key);
  if (!first || !second) return std::nullopt;
  return Vec2(*first, *second);
}

}  // namespace

std::span<const Preset> presets() { return kPresets; }

scene::Loaded<PictureStyle> load_style(std::string_view text, const std::string& file, PictureStyle style) {
  std::vector<Problem> problems;
  const std::optional<Node> document = scene::parse_document(text, file, problems);
  if (!document) return problems;
  if (document->kind != Node::Kind::kObject) {
    return std::vector<Problem>{problem_at(document->place, "", "a style is an object, not " + describe(*document))};
  }
  if (const scene::Member* base = document->find(kBase)) {
    const Preset* preset = base->value.kind == Node::Kind::kString ? find_preset(base->value.text) : nullptr;
    if (preset != nullptr) {
      style = *load_style(preset->text, preset->name, style);
    } else {
      problems.push_back(
          problem_at(base->value.place, kBase, "may be " + list_of(preset_names()) + ", not " + describe(base->value)));
    }
  }
  std::vector<std::string> known{kBase};
  for (const StyleKey& key : style_keys()) known.emplace_back(key.name);
  for (const scene::Member& member : document->members) {
    if (member.key == kBase) continue;
    const StyleKey* key = find_style_key(member.key);
    if (key == nullptr) {
      problems.push_back(
          problem_at(member.place, member.key,
                     "there is no such key in a style" + scene::did_you_mean(scene::nearest(member.key, known))));
    }
  }
  // In the table's order, whatever that of the file is: a range belongs to the colour that it stands with.
  for (const StyleKey& key : style_keys()) {
    const scene::Member* member = document->find(key.name);
    if (member == nullptr) continue;
    std::string wanted;
    const std::optional<StyleValue> value = value_in(member->value, key, wanted);
    if (!value) {
      problems.push_back(
          problem_at(member->value.place, key.name, "must be " + wanted + ", not " + describe(member->value)));
      continue;
    }
    if (auto done = set(style, key, *value); !done) {
      problems.push_back(problem_at(member->value.place, key.name, done.error().message));
    }
  }
  if (problems.empty()) {
    if (auto done = check(style); !done) problems.push_back(problem_at(document->place, "", done.error().message));
  }
  if (!problems.empty()) return scene::tidied(std::move(problems));
  return style;
}

Result<PictureStyle> named_style(const std::string& name, const PictureStyle& style) {
  if (const Preset* preset = find_preset(name)) return *load_style(preset->text, preset->name, style);
  std::error_code ignored;
  if (!std::filesystem::exists(name, ignored)) {
    return Error{fmt::format("there is no style '{}': give one of {}, or a file{}", name, list_of(preset_names()),
                             scene::did_you_mean(scene::nearest(name, preset_names())))};
  }
  const Result<std::string> text = read_input(name);
  if (!text) return text.error();
  scene::Loaded<PictureStyle> loaded = load_style(*text, name, style);
  if (!loaded) return Error{to_string(loaded.error())};
  return *loaded;
}

std::string presets_as_markdown() {
  std::string table = "| `--style` | what it shows |\n|---|---|\n";
  for (const Preset& preset : kPresets) table += fmt::format("| `{}` | {} |\n", preset.name, preset.doc);
  return table;
}

}  // namespace shaken::render
