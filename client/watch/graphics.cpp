// SPDX-License-Identifier: MIT
#include "client/watch/graphics.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include "client/watch/kitty.h"

namespace shaken::client {
namespace {

/// The numbers between semicolons; nothing if there is anything else.
std::optional<std::vector<int>> numbers_of(std::string_view text) {
  std::vector<int> numbers;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(';'));
    int number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return numbers;
}

/// What is between `begin` and `end`; nothing if they are not there.
std::optional<std::string_view> inside(std::string_view text, std::string_view begin, std::string_view end) {
  if (text.size() < begin.size() + end.size() || !text.starts_with(begin) || !text.ends_with(end)) return std::nullopt;
  return text.substr(begin.size(), text.size() - begin.size() - end.size());
}

}  // namespace

std::optional<Graphics> graphics_named(std::string_view name) {
  if (name == "auto") return Graphics::kAuto;
  if (name == "blocks") return Graphics::kBlocks;
  if (name == "sixel") return Graphics::kSixel;
  if (name == "kitty") return Graphics::kKitty;
  return std::nullopt;
}

bool is_in_multiplexer(const std::function<const char*(const char*)>& variable) {
  const auto value = [&](const char* name) {
    const char* text = variable(name);
    return std::string_view(text == nullptr ? "" : text);
  };
  const std::string_view terminal = value("TERM");
  return !value("TMUX").empty() || !value("STY").empty() || terminal.starts_with("screen") ||
         terminal.starts_with("tmux");
}

void TerminalAnswers::note(std::string_view sequence) {
  constexpr int kSixelAttribute = 4;
  if (const auto kitty = inside(sequence, "\x1b_G", "\x1b\\")) {
    knows_kitty |= kitty->ends_with(";OK");
  } else if (const auto attributes = inside(sequence, "\x1b[?", "c")) {
    const auto numbers = numbers_of(*attributes);
    if (!numbers) return;
    // The first is no attribute, but the kind of terminal.
    knows_sixel |=
        std::find(numbers->begin() + (numbers->empty() ? 0 : 1), numbers->end(), kSixelAttribute) != numbers->end();
    ++n_complete;
  } else if (const auto size = inside(sequence, "\x1b[4;", "t")) {
    if (const auto numbers = numbers_of(*size); numbers && numbers->size() == 2) {
      window = PixelSize{.width = (*numbers)[1], .height = (*numbers)[0]};
    }
  }
}

Graphics TerminalAnswers::best() const {
  if (n_complete == 0) return Graphics::kBlocks;
  if (knows_kitty) return Graphics::kKitty;
  return knows_sixel ? Graphics::kSixel : Graphics::kBlocks;
}

std::string terminal_questions() { return kitty_query() + "\x1b[14t\x1b[c"; }

std::optional<PixelSize> cell_size(PixelSize window, int columns, int lines) {
  constexpr int kLeast = 2, kMost = 200;
  if (columns <= 0 || lines <= 0) return std::nullopt;
  const PixelSize cell{.width = window.width / columns, .height = window.height / lines};
  const bool is_usual = std::min(cell.width, cell.height) >= kLeast && std::max(cell.width, cell.height) <= kMost;
  return is_usual ? std::optional(cell) : std::nullopt;
}

}  // namespace shaken::client
