#include "client/watch/screen_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace shaken::client {
namespace {

constexpr const char* kBeginUpdate = "\x1b[?2026h";
constexpr const char* kEndUpdate = "\x1b[?2026l";

int part(Ink rgb, int shift) { return rgb >> shift & 0xFF; }

int squared_distance(Ink a, Ink b) {
  int sum = 0;
  for (const int shift : {16, 8, 0}) {
    const int d = part(a, shift) - part(b, shift);
    sum += d * d;
  }
  return sum;
}

/// The number of a colour of the terminal's theme or of a palette, for the foreground (30) or the background (40).
std::string short_colour(int number, int base) {
  return number < 8 ? fmt::format("{}", base + number) : fmt::format("{}", base + 60 + number - 8);
}

std::string colour_code(Ink ink, int base, ColourDepth depth) {
  if (ink == kOwnInk || depth == ColourDepth::kNone) return fmt::format("{}", base + 9);
  if (ink < kOwnInk) return short_colour(-2 - ink, base);
  if (depth == ColourDepth::k16) return short_colour(nearest_of_16(ink), base);
  if (depth == ColourDepth::k256) return fmt::format("{};5;{}", base + 8, nearest_of_256(ink));
  return fmt::format("{};2;{};{};{}", base + 8, part(ink, 16), part(ink, 8), part(ink, 0));
}

/// The cell, among those that look like `cell`, that needs the fewest changes of colour after `style`: nothing of a
/// blank is seen but what is behind it, and a half block may be turned over.
ScreenCell cheapest(const ScreenCell& cell, const ScreenCell& style) {
  if (cell.glyph == U' ') return {.fore = style.fore, .back = cell.back, .bold = style.bold, .dim = style.dim};
  // The terminal's own two colours differ, and bold letters may be brighter.
  const bool can_turn =
      (cell.glyph == U'▀' || cell.glyph == U'▄') && cell.fore >= 0 && cell.back >= 0 && !cell.bold && !cell.dim;
  if (!can_turn) return cell;
  const auto n_changes = [&style](const ScreenCell& c) { return (c.fore != style.fore) + (c.back != style.back); };
  const ScreenCell turned{.glyph = cell.glyph == U'▀' ? U'▄' : U'▀', .fore = cell.back, .back = cell.fore};
  return n_changes(turned) < n_changes(cell) ? turned : cell;
}

/// The purest colour of the same hue, where there is a hue to speak of: sixteen colours have no dull ones but greys.
Ink saturated(Ink rgb) {
  constexpr int kGreyish = 64;
  const auto [low, high] = std::minmax({part(rgb, 16), part(rgb, 8), part(rgb, 0)});
  if (high - low < kGreyish) return rgb;
  Ink pure = 0;
  for (const int shift : {16, 8, 0}) pure |= (part(rgb, shift) - low) * high / (high - low) << shift;
  return pure;
}

bool same_style(const ScreenCell& a, const ScreenCell& b) {
  return a.fore == b.fore && a.back == b.back && a.bold == b.bold && a.dim == b.dim;
}

}  // namespace

ColourDepth colour_depth(const std::function<const char*(const char*)>& variable) {
  const auto value = [&](const char* name) {
    const char* text = variable(name);
    return std::string_view(text == nullptr ? "" : text);
  };
  if (!value("NO_COLOR").empty()) return ColourDepth::kNone;
  const std::string_view terminal = value("TERM");
  if (terminal.empty() || terminal == "dumb" || terminal == "vt100" || terminal == "vt220") return ColourDepth::kNone;
  const std::string_view promised = value("COLORTERM");
  if (promised == "truecolor" || promised == "24bit" || terminal.ends_with("-direct")) return ColourDepth::kTrue;
  return terminal.find("256color") != std::string_view::npos ? ColourDepth::k256 : ColourDepth::k16;
}

int nearest_of_256(Ink rgb) {
  static constexpr std::array kSteps{0, 95, 135, 175, 215, 255};
  const auto nearest_step = [](int value) {
    return static_cast<int>(
        std::min_element(kSteps.begin(), kSteps.end(),
                         [value](int a, int b) { return std::abs(a - value) < std::abs(b - value); }) -
        kSteps.begin());
  };
  const int r = nearest_step(part(rgb, 16)), g = nearest_step(part(rgb, 8)), b = nearest_step(part(rgb, 0));
  const auto step = [](int i) { return kSteps[static_cast<std::size_t>(i)]; };
  const Ink in_cube = step(r) << 16 | step(g) << 8 | step(b);
  const int mean = (part(rgb, 16) + part(rgb, 8) + part(rgb, 0)) / 3;
  const int grey = std::clamp((mean - 3) / 10, 0, 23);
  const int level = 8 + 10 * grey;
  if (squared_distance(rgb, level << 16 | level << 8 | level) < squared_distance(rgb, in_cube)) return 232 + grey;
  return 16 + 36 * r + 6 * g + b;
}

int nearest_of_16(Ink rgb) {
  static constexpr std::array<Ink, 16> kXterm{0x000000, 0xCD0000, 0x00CD00, 0xCDCD00, 0x0000EE, 0xCD00CD,
                                              0x00CDCD, 0xE5E5E5, 0x7F7F7F, 0xFF0000, 0x00FF00, 0xFFFF00,
                                              0x5C5CFF, 0xFF00FF, 0x00FFFF, 0xFFFFFF};
  const Ink full = saturated(rgb);
  return static_cast<int>(
      std::min_element(kXterm.begin(), kXterm.end(),
                       [full](Ink a, Ink b) { return squared_distance(a, full) < squared_distance(b, full); }) -
      kXterm.begin());
}

std::string ScreenWriter::style_text(const ScreenCell& cell) const {
  std::string text = "\x1b[0";
  if (cell.bold) text += ";1";
  if (cell.dim) text += ";2";
  if (cell.fore != kOwnInk && depth_ != ColourDepth::kNone) text += ";" + colour_code(cell.fore, 30, depth_);
  if (cell.back != kOwnInk && depth_ != ColourDepth::kNone) text += ";" + colour_code(cell.back, 40, depth_);
  return text + "m";
}

bool ScreenWriter::draws_whole(const CellGrid& grid) const {
  return !last_ || last_->columns() != grid.columns() || last_->lines() != grid.lines();
}

std::string ScreenWriter::update(const CellGrid& grid) {
  const bool is_whole = draws_whole(grid);
  std::string text;
  ScreenCell style;  // what the terminal writes with
  for (int line = 0; line < grid.lines(); ++line) {
    int cursor = -1;  // column, if the cursor is known to be in this line
    for (int column = 0; column < grid.columns(); ++column) {
      const ScreenCell& wanted = grid.at(column, line);
      if (is_whole ? wanted == ScreenCell{} : wanted == last_->at(column, line)) continue;
      const ScreenCell cell = cheapest(wanted, style);
      if (cursor < 0) {
        text += fmt::format("\x1b[{};{}H", line + 1, column + 1);
      } else if (cursor < column) {
        text += fmt::format("\x1b[{}C", column - cursor);
      }
      if (!same_style(cell, style)) {
        // One colour changes more often than all; what is bold can only be ended by ending all.
        if (cell.bold == style.bold && cell.dim == style.dim) {
          std::string codes;
          if (cell.fore != style.fore) codes = colour_code(cell.fore, 30, depth_);
          if (cell.back != style.back) codes += (codes.empty() ? "" : ";") + colour_code(cell.back, 40, depth_);
          if (depth_ != ColourDepth::kNone) text += "\x1b[" + codes + "m";
        } else {
          text += style_text(cell);
        }
        style = cell;
      }
      append_utf8(text, cell.glyph);
      cursor = column + 1;
    }
  }
  last_ = grid;
  if (is_whole) text = "\x1b[0m\x1b[2J" + text;
  if (!text.empty()) text += "\x1b[0m";
  return text.empty() ? text : kBeginUpdate + text + kEndUpdate;
}

}  // namespace shaken::client
