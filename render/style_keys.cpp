// SPDX-License-Identifier: MIT
#include "render/style_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "base/picture_limits.h"
#include "render/colourings.h"

namespace shaken::render {
namespace {

constexpr double kMostRods = 1e6;

StyleKey switch_key(const char* name, std::string doc, bool PictureStyle::*at) {
  return {name,
          StyleForm::kSwitch,
          "",
          std::move(doc),
          0,
          0,
          {},
          [at](const PictureStyle& style) { return style.*at; },
          [at](PictureStyle& style, const StyleValue& value) -> Result<void> {
            style.*at = std::get<bool>(value);
            return {};
          }};
}

StyleKey light_key(const char* name, std::string doc, bool Light::*at) {
  return {name,
          StyleForm::kSwitch,
          "",
          std::move(doc),
          0,
          0,
          {},
          [at](const PictureStyle& style) { return style.light.*at; },
          [at](PictureStyle& style, const StyleValue& value) -> Result<void> {
            style.light.*at = std::get<bool>(value);
            return {};
          }};
}

StyleKey number_key(const char* name, const char* value_name, std::string doc, double low, double high,
                    double PictureStyle::*at) {
  return {name,
          StyleForm::kNumber,
          value_name,
          std::move(doc),
          low,
          high,
          {},
          [at](const PictureStyle& style) { return style.*at; },
          [at](PictureStyle& style, const StyleValue& value) -> Result<void> {
            style.*at = std::get<double>(value);
            return {};
          }};
}

/// A member whose values are counted from 0, each with its word.
template <class Enum>
StyleKey word_key(const char* name, std::string doc, std::vector<std::string> words, Enum PictureStyle::*at) {
  const std::vector<std::string> all = words;
  return {name,
          StyleForm::kWord,
          "WORD",
          std::move(doc),
          0,
          0,
          std::move(words),
          [at, all](const PictureStyle& style) { return all[static_cast<std::size_t>(style.*at)]; },
          [at, all](PictureStyle& style, const StyleValue& value) -> Result<void> {
            const auto found = std::find(all.begin(), all.end(), std::get<std::string>(value));
            style.*at = static_cast<Enum>(found - all.begin());
            return {};
          }};
}

constexpr const char* kViews = "top, gap, follow:N, follow:plus or follow:minus";

StyleValue view_word(const PictureStyle& style) {
  if (style.followed) return fmt::format("follow:{}", *style.followed);
  if (style.followed_defect) {
    const auto& [charge, rank] = *style.followed_defect;
    return fmt::format("follow:{}{}", charge > 0 ? "plus" : "minus", rank > 0 ? fmt::format(":{}", rank) : "");
  }
  return std::string(style.view == ViewPoint::kGap ? "gap" : "top");
}

/// A number counted from 0; nothing if it is none, or beyond all rods.
std::optional<int> count_in(const std::string& digits) {
  if (digits.empty() || digits.size() > 7 || digits.find_first_not_of("0123456789") != std::string::npos ||
      std::stod(digits) > kMostRods) {
    return std::nullopt;
  }
  return std::stoi(digits);
}

Result<void> set_view(PictureStyle& style, const StyleValue& value) {
  const auto& word = std::get<std::string>(value);
  std::optional<int> rod;
  std::optional<FollowedDefect> defect;
  if (word != "top" && word != "gap") {
    const std::string_view follow = "follow:";
    const std::string what = word.starts_with(follow) ? word.substr(follow.size()) : "";
    rod = count_in(what);
    for (const auto& [name, charge] : {std::pair{std::string("plus"), 0.5}, {"minus", -0.5}}) {
      if (what == name) defect = {charge, 0};
      if (!what.starts_with(name + ":")) continue;
      const std::optional<int> rank = count_in(what.substr(name.size() + 1));
      if (rank) defect = {charge, static_cast<std::size_t>(*rank)};
    }
    if (!rod && !defect) {
      return Error{fmt::format(
          "may be {}, N being the number of a rod, counted from 0; follow:plus:1 is the +1/2 defect that lives longest "
          "but one",
          kViews)};
    }
    // A close-up, unless the style says how close.
    if (style.zoom <= 1) style.zoom = 4;
  }
  style.view = word == "gap" ? ViewPoint::kGap : ViewPoint::kTop;
  style.followed = rod;
  style.followed_defect = defect;
  return {};
}

std::vector<StyleKey> make_keys() {
  std::vector<StyleKey> keys;
  keys.push_back({"size",
                  StyleForm::kSize,
                  "WxH",
                  "Pixels; wide, square and tall pictures are laid out differently",
                  kLeastPixels,
                  kMostPixels,
                  {},
                  [](const PictureStyle& style) { return Vec2(style.width, style.height); },
                  [](PictureStyle& style, const StyleValue& value) -> Result<void> {
                    const Vec2& size = std::get<Vec2>(value);
                    style.width = static_cast<int>(size.x());
                    style.height = static_cast<int>(size.y());
                    return {};
                  }});
  keys.push_back({"colour", StyleForm::kWord, "NAME", "What colours a rod", 0, 0, colour_names(),
                  [](const PictureStyle& style) { return style.colour; },
                  [](PictureStyle& style, const StyleValue& value) -> Result<void> {
                    style.colour = std::get<std::string>(value);
                    style.range.reset();
                    return {};
                  }});
  keys.push_back({"range",
                  StyleForm::kPair,
                  "LOW,HIGH",
                  "Ends of the colour scale, in its unit",
                  -1e6,
                  1e6,
                  {},
                  [](const PictureStyle& style) { return style.range.value_or(Vec2(0, 0)); },
                  [](PictureStyle& style, const StyleValue& value) -> Result<void> {
                    const Vec2& range = std::get<Vec2>(value);
                    if (!(range.x() < range.y())) return Error{"must rise from the first number to the second"};
                    style.range = range;
                    return {};
                  }});
  keys.push_back(
      word_key("theme", "Colours of page, floor and text", {"light", "dark", "print"}, &PictureStyle::theme));
  keys.push_back(
      number_key("rods", "OPACITY", "Opacity of the rods over the background; 0: none", 0, 1, &PictureStyle::rods));
  keys.push_back({"samples",
                  StyleForm::kNumber,
                  "N",
                  "Rays along each side of a pixel; 1 is for a first look",
                  1,
                  3,
                  {},
                  [](const PictureStyle& style) { return static_cast<double>(style.light.samples); },
                  [](PictureStyle& style, const StyleValue& value) -> Result<void> {
                    const double samples = std::get<double>(value);
                    if (samples != std::floor(samples)) return Error{"is a whole number"};
                    style.light.samples = static_cast<int>(samples);
                    return {};
                  }});
  keys.push_back(light_key("shadows", "Soft shadows on the floor", &Light::shadows));
  keys.push_back(light_key("gloss", "Rods shine where they throw the light back", &Light::gloss));
  keys.push_back(light_key("occlusion", "Rods are darker at their sides, which see neighbours rather than the sky",
                           &Light::occlusion));
  keys.push_back(light_key("smooth", "Rods look like smooth bodies; else each of their beads is seen", &Light::smooth));
  keys.push_back(word_key("background", "What lies under the rods: the floor, or the local order S (dark: none)",
                          {"none", "order"}, &PictureStyle::background));
  keys.push_back(
      word_key("lines", "The director field over the rods", {"none", "bars", "streamlines"}, &PictureStyle::lines));
  keys.push_back(switch_key("defects", "Looks for defects and marks them: +1/2 comets, -1/2 three arms",
                            &PictureStyle::mark_defects));
  keys.push_back(
      number_key("tracks", "S", "For how long defects leave a track that fades", 0, 1000, &PictureStyle::tracks));
  keys.push_back(number_key("displacements", "S", "Arrows from where each rod's centre was so long before", 0, 1e6,
                            &PictureStyle::displacements));
  keys.push_back(word_key("inset",
                          "A plot in a corner of the rods: P(theta), G2(r) and the map G2(x, y) of this instant; S(t), "
                          "which then stands there only; the points of the sweep with a ring round this one (--sweep)",
                          {"none", "angles", "order", "g2", "g2-map", "sweep"}, &PictureStyle::inset));
  keys.push_back(switch_key("caption", "Headline, numbers and S(t)", &PictureStyle::caption));
  keys.push_back(switch_key("legend", "The colour scale, with how many rods have which colour", &PictureStyle::legend));
  keys.push_back(switch_key("scale_bar", "A scale bar; in films also the playback speed", &PictureStyle::scale_bar));
  keys.push_back({"view",
                  StyleForm::kWord,
                  "VIEW",
                  "top: from above; gap: into the gap, in perspective; follow:N: rod N stays in the middle, 4 times "
                  "enlarged unless zoom says otherwise; follow:plus, follow:minus: the defect of that sign that lives "
                  "longest, follow:plus:1 the next one",
                  0,
                  0,
                  {},
                  view_word,
                  set_view});
  keys.push_back(switch_key("whole",
                            "Rods across the border of a periodic box are drawn once and whole, beyond its frame, and "
                            "not as two pieces; in the view from above that shows all of the box",
                            &PictureStyle::whole));
  keys.push_back(
      number_key("zoom", "FACTOR", "Shows a part of the box, this many times enlarged", 1, 1000, &PictureStyle::zoom));
  keys.push_back({"focus",
                  StyleForm::kPair,
                  "X,Y",
                  "Middle of the enlarged part, in box sides",
                  -1e6,
                  1e6,
                  {},
                  [](const PictureStyle& style) { return style.focus; },
                  [](PictureStyle& style, const StyleValue& value) -> Result<void> {
                    style.focus = std::get<Vec2>(value);
                    return {};
                  }});
  keys.push_back(number_key("fps", "N", "Frames per second of playing", 0.1, 1000, &PictureStyle::fps));
  keys.push_back({"speed",
                  StyleForm::kNumber,
                  "FACTOR",
                  "Simulated seconds per second of playing, 0.1 for slow motion; each frame shows the recorded one "
                  "nearest in time. If not given, recorded frames follow each other as movie.every says",
                  1e-6,
                  1e6,
                  {},
                  [](const PictureStyle& style) { return style.speed.value_or(0); },
                  [](PictureStyle& style, const StyleValue& value) -> Result<void> {
                    style.speed = std::get<double>(value);
                    return {};
                  }});
  return keys;
}

std::string say(const StyleKey& key, const StyleValue& value) {
  switch (key.form) {
    case StyleForm::kSwitch:
      return std::get<bool>(value) ? "true" : "false";
    case StyleForm::kNumber:
      return fmt::format("{:g}", std::get<double>(value));
    case StyleForm::kWord:
      return std::get<std::string>(value);
    case StyleForm::kPair:
    case StyleForm::kSize:
      break;
  }
  const Vec2& pair = std::get<Vec2>(value);
  return fmt::format("[{:g}, {:g}]", pair.x(), pair.y());
}

Result<void> check_range(const StyleKey& key, double value) {
  if (value >= key.low && value <= key.high) return {};  // false for NaN
  return Error{fmt::format("may be {}, not {:g}", allowed(key), value)};
}

/// `text` as a number, all of it.
Result<double> number_in(const std::string& text) {
  std::istringstream in(text);
  double number = 0;
  if (!(in >> number) || in.peek() != EOF) return Error{"is a number, not '" + text + "'"};
  return number;
}

}  // namespace

std::span<const StyleKey> style_keys() {
  static const std::vector<StyleKey> keys = make_keys();
  return keys;
}

const StyleKey* find_style_key(std::string_view name) {
  const auto keys = style_keys();
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const StyleKey& key) { return name == key.name; });
  return found == keys.end() ? nullptr : &*found;
}

std::string allowed(const StyleKey& key) {
  if (key.form == StyleForm::kSwitch) return "true or false";
  if (key.form == StyleForm::kWord) {
    std::string all;
    for (std::size_t i = 0; i < key.words.size(); ++i) {
      all += (i == 0 ? "" : i + 1 == key.words.size() ? " or " : ", ") + key.words[i];
    }
    return all.empty() ? kViews : all;
  }
  const std::string range = fmt::format("{:g} to {:g}", key.low, key.high);
  return key.form == StyleForm::kNumber ? range : range + " each";
}

Result<void> set(PictureStyle& style, const StyleKey& key, const StyleValue& value) {
  if (key.form == StyleForm::kNumber) {
    if (auto done = check_range(key, std::get<double>(value)); !done) return done.error();
  }
  if (key.form == StyleForm::kPair || key.form == StyleForm::kSize) {
    const Vec2& pair = std::get<Vec2>(value);
    for (const double x : {pair.x(), pair.y()}) {
      if (auto done = check_range(key, x); !done) return done.error();
      if (key.form == StyleForm::kSize && x != std::floor(x)) return Error{"takes whole numbers of pixels"};
    }
  }
  if (key.form == StyleForm::kWord && !key.words.empty()) {
    const auto& word = std::get<std::string>(value);
    if (std::find(key.words.begin(), key.words.end(), word) == key.words.end()) {
      return Error{fmt::format("may be {}, not '{}'", allowed(key), word)};
    }
  }
  return key.store(style, value);
}

Result<void> set_from_text(PictureStyle& style, const StyleKey& key, const std::string& text) {
  switch (key.form) {
    case StyleForm::kSwitch:
      return set(style, key, text == "true");
    case StyleForm::kWord:
      return set(style, key, text);
    case StyleForm::kNumber: {
      const Result<double> number = number_in(text);
      return number ? set(style, key, *number) : Result<void>(number.error());
    }
    case StyleForm::kPair:
    case StyleForm::kSize:
      break;
  }
  const char separator = key.form == StyleForm::kSize ? 'x' : ',';
  const std::size_t at = text.find(separator);
  const Error wrong{fmt::format("takes {}, not '{}'", key.value_name, text)};
  if (at == std::string::npos) return wrong;
  const Result<double> first = number_in(text.substr(0, at)), second = number_in(text.substr(at + 1));
  if (!first || !second) return wrong;
  return set(style, key, Vec2(*first, *second));
}

std::string style_keys_as_markdown() {
  const PictureStyle usual;
  std::string table = "| key | values | default | meaning |\n|---|---|---|---|\n";
  for (const StyleKey& key : style_keys()) {
    const bool open = std::string_view(key.name) == "range" || std::string_view(key.name) == "speed";
    std::string values = allowed(key);
    if (key.form == StyleForm::kPair) values = fmt::format("[{}]", key.value_name);
    if (key.form == StyleForm::kSize) values.insert(0, "[width, height], ");
    table +=
        fmt::format("| `{}` | {} | {} | {} |\n", key.name, values, open ? "" : say(key, key.fetch(usual)), key.doc);
  }
  return table;
}

}  // namespace shaken::render
