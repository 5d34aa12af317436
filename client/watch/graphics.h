// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "client/watch/rod_image.h"

namespace shaken::client {

/// How rods come to a terminal (`shaken watch --graphics`).
enum class Graphics {
  kAuto,    ///< as images if the terminal says that it shows them
  kBlocks,  ///< as characters
  kSixel,   ///< as images by sixels
  kKitty,   ///< as images by the protocol of kitty
};
inline constexpr const char* kGraphicsNames = "auto|blocks|sixel|kitty";
std::optional<Graphics> graphics_named(std::string_view name);

/// Whether the terminal is that of tmux or screen, which hand images on in part only, by TMUX, STY and TERM, which
/// `variable` looks up (std::getenv).
bool is_in_multiplexer(const std::function<const char*(const char*)>& variable);

/// What a terminal has said of itself.
struct TerminalAnswers {
  bool knows_kitty = false;
  bool knows_sixel = false;
  std::optional<PixelSize> window;  ///< the part with characters
  int n_complete = 0;               ///< how often all questions have been answered

  /// An answer as KeyReader has it. What does not answer terminal_questions() changes nothing.
  void note(std::string_view sequence);
  /// What kAuto stands for: kitty's protocol, which takes fewer bytes, before sixels; blocks before all is answered.
  Graphics best() const;
};

/// Asks for kitty's protocol, for the window's size in pixels (XTWINOPS 14) and for attributes (DA1). Every terminal
/// answers the last, and answers come in the order of the questions.
std::string terminal_questions();

/// The size of a character, from that of a window; nothing if it is unknown or none that characters have.
std::optional<PixelSize> cell_size(PixelSize window, int columns, int lines);

}  // namespace shaken::client
