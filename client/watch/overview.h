#pragma once

#include <string>
#include <vector>

#include "client/console.h"
#include "client/live/live.h"

namespace shaken::client {

/// The jobs as a screen of at most console.width x console.height: a summary, for each running job a bar, numbers and a
/// chart of S(t) as far as there is room, and `note` (where the numbers come from) at the bottom.
std::vector<std::string> watch_screen(const LiveJobs& jobs, const std::string& title, const std::string& note,
                                      const Console& console);

/// S(t) of a job as a chart of `height` lines, at most `width` columns wide; nothing if there is no room. Its time axis
/// begins at 0; where more than the first twentieth of S(t) is missing, as of a run that leaves no files to be read, it
/// begins where S(t) does, and says "live only".
std::vector<std::string> order_chart(const LiveJob& job, int width, int height);

/// "rods 143.9 base 4383 lid 610.4".
std::string hits_text(const HitRates& rates);

/// How far a job that draws its film is with it: "drawing the film 42 %, ETA 12 s".
std::string film_text(const LiveJob& job);

/// A job on one line, for logs and pipes.
std::string watch_line(const LiveJob& job);

}  // namespace shaken::client
