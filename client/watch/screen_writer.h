#pragma once

#include <functional>
#include <optional>
#include <string>

#include "client/watch/cells.h"

namespace shaken::client {

/// How many colours a terminal has.
enum class ColourDepth { kNone, k16, k256, kTrue };

/// By NO_COLOR, COLORTERM and TERM, which `variable` looks up (std::getenv): none where NO_COLOR is set to anything;
/// 2^24 where COLORTERM is "truecolor" or "24bit", or TERM ends in "-direct"; 256 where TERM has "256color"; none for
/// "dumb", "vt100", "vt220" and no TERM at all; otherwise 16.
ColourDepth colour_depth(const std::function<const char*(const char*)>& variable);

/// The nearest of xterm's 256 colours (16 to 255: a cube and greys).
int nearest_of_256(Ink rgb);
/// The nearest of its first 16 to the purest colour of the same hue; to the colour itself if that is greyish.
int nearest_of_16(Ink rgb);

/// Brings screens to a terminal, each as the cells that differ from the one before, so that a slow line is not flooded.
class ScreenWriter {
 public:
  explicit ScreenWriter(ColourDepth depth) : depth_(depth) {}

  /// The bytes that turn the last screen into `grid`; none if they are equal. A screen of another size is drawn whole.
  /// They are marked as one update (mode 2026), so that terminals which know that do not show half of it.
  std::string update(const CellGrid& grid);
  /// The next screen is drawn whole: something else has written on the terminal.
  void forget() { last_.reset(); }

 private:
  /// Whether `grid` will be drawn whole, over whatever is on the terminal.
  bool draws_whole(const CellGrid& grid) const;
  std::string style_text(const ScreenCell& cell) const;

  ColourDepth depth_;
  std::optional<CellGrid> last_;
};

}  // namespace shaken::client
