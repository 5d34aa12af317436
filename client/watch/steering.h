#pragma once

#include <span>
#include <string>

#include "base/core/types.h"
#include "client/watch/keys.h"
#include "client/watch/rod_cells.h"

namespace shaken::client {

/// What the keys have set.
struct Steering {
  std::string job;  ///< whose rods are shown
  RodView view{};
  Colouring colouring = Colouring::kAuto;
  Colouring automatic = Colouring::kLayers;  ///< what kAuto stands for now
  Grain grain = Grain::kAuto;
  bool shows_defects = true;
  bool paused = false;   ///< the picture stands still; the run goes on
  bool numbers = false;  ///< numbers and curves of all runs in place of the rods of one
  bool help = false;
  bool redraw = false;   ///< everything is to be drawn anew
  bool suspend = false;  ///< Ctrl-Z
  bool quit = false;

  Colouring shown_colouring() const { return colouring == Colouring::kAuto ? automatic : colouring; }
};

/// What a key changes. `jobs` are those that can be chosen, in order; where `period` is not 0, the view may leave the
/// box on one side and come back on the other.
Steering steered(Steering state, const Key& key, std::span<const std::string> jobs, const Vec2& period);

/// The keys as a list, a line each, for the help.
inline constexpr const char* kWatchKeys[] = {
    "q            leave; the runs go on",
    "Tab, n / p   next / previous run; 1 to 9: the first nine",
    "space        hold the picture, or let it go; the run goes on",
    "+ / -        zoom in / out; 0: the whole box",
    "arrows       move the view",
    "c            colours: auto, angle to the director, angle, tilt, species",
    "b            fine dots, or coloured blocks",
    "d            defects, or none",
    "o            numbers and S(t) of all runs, or the rods of one",
    "?            these keys",
};

}  // namespace shaken::client
