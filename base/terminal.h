#pragma once

#include <optional>

namespace shaken {

struct TerminalSize {
  int columns = 0;
  int lines = 0;
};

/// Of the terminal that `descriptor` writes to; nothing if it is none, or does not know its size.
std::optional<TerminalSize> terminal_size(int descriptor);

}  // namespace shaken
