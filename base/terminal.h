#pragma once

#include <sys/ioctl.h>

#include <optional>

namespace shaken {

struct TerminalSize {
  int columns = 0;
  int lines = 0;
};

/// The size of the terminal that `descriptor` writes to; nothing if it is none, or does not know its size.
inline std::optional<TerminalSize> terminal_size(int descriptor) {
  winsize size{};
  if (ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return std::nullopt;
  return TerminalSize{size.ws_col, size.ws_row};
}

}  // namespace shaken
