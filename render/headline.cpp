// SPDX-License-Identifier: MIT
#include "render/headline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/keys/units.h"
#include "scene/fields.h"

namespace shaken::render {
namespace {

/// What physicists write for the keys that are swept most.
constexpr std::pair<std::string_view, const char*> kSymbols[] = {
    {"rods.area_fraction", "\u03c6"},
    {"rods.length", "\u2113"},
    {"rods.count", "N"},
    {"plates.gamma", "\u0393"},
    {"plates.frequency", "f"},
    {"plates.amplitude", "A"},
    {"box.side", "L"},
    {"box.gap", "w"},
    {"time.step", "dt"},
};

}  // namespace

std::string symbol_of(const std::string& path) {
  const auto* symbol =
      std::find_if(std::begin(kSymbols), std::end(kSymbols), [&](const auto& known) { return known.first == path; });
  return symbol != std::end(kSymbols) ? symbol->second : path.substr(path.rfind('.') + 1);
}

namespace {

/// One setting, or nothing if `word` is none.
std::string spoken(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) return "";
  const std::string path = word.substr(0, equals), value = word.substr(equals + 1);
  if (path == "replica") return "replica " + value;
  if (scene::field_index(path) < 0) return "";
  const scene::Field& field = scene::field_at(path);
  const auto number = keys::parse_quantity(value, field.dimension);
  const bool is_plain = field.form != keys::Form::kQuantity || field.dimension == keys::Dimension::kPlain;
  return fmt::format("{} = {}", symbol_of(path),
                     number && !is_plain ? keys::format_quantity(*number, field.dimension) : value);
}

}  // namespace

std::string headline(const std::string& label) {
  std::string all;
  std::istringstream words(label);
  bool was_setting = true;
  for (std::string word; words >> word;) {
    const std::string setting = spoken(word);
    const bool is_setting = !setting.empty();
    if (!all.empty()) all += is_setting && was_setting ? ", " : " ";
    all += is_setting ? setting : word;
    was_setting = is_setting;
  }
  return all;
}

}  // namespace shaken::render
