#include "client/watch/screen_layout.h"

#include <fmt/format.h>

#include <algorithm>

namespace shaken::client {
namespace {

// Beside each other.
constexpr int kFewestColumns = 60;
constexpr int kFewestLines = 16;
constexpr int kNumberColumns = 32;  // at least
// Under each other.
constexpr int kFewestStackedColumns = 40;
constexpr int kFewestStackedLines = 28;
constexpr int kNumberLines = 9;
constexpr int kMostNumberLines = 20;

constexpr int kFrameLines = 3;  // title, legend, status

/// Half-cells along the side of the square that fits into the picture.
int side_of(const WatchLayout& layout) { return std::min(layout.picture.columns, 2 * layout.picture.lines); }

std::optional<WatchLayout> beside(int columns, int lines) {
  if (columns < kFewestColumns || lines < kFewestLines) return std::nullopt;
  const int height = lines - kFrameLines;
  const int width = std::min(2 * height, columns - 1 - kNumberColumns);
  return WatchLayout{.picture = {0, 1, width, height},
                     .legend = {0, lines - 2, width, 1},
                     .numbers = {width + 1, 1, columns - width - 1, lines - 2}};
}

std::optional<WatchLayout> stacked(int columns, int lines) {
  if (columns < kFewestStackedColumns || lines < kFewestStackedLines) return std::nullopt;
  const int free = lines - kFrameLines;
  const int below = std::clamp(free - (columns + 1) / 2, kNumberLines, kMostNumberLines);
  return WatchLayout{.picture = {0, 1, columns, free - below},
                     .legend = {0, 1 + free - below, columns, 1},
                     .numbers = {0, 2 + free - below, columns, below}};
}

}  // namespace

std::optional<WatchLayout> watch_layout(int columns, int lines) {
  const std::optional<WatchLayout> a = beside(columns, lines), b = stacked(columns, lines);
  if (!a) return b;
  return b && side_of(*b) > side_of(*a) ? b : a;
}

std::string size_note(int columns, int lines) {
  return fmt::format("the rods need a terminal of {}x{} or {}x{}; this one has {}x{}", kFewestColumns, kFewestLines,
                     kFewestStackedColumns, kFewestStackedLines, columns, lines);
}

}  // namespace shaken::client
