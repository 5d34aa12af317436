#pragma once

#include <string_view>

namespace shaken::client {

/// The scene that `shaken init` writes: the paper's rods, so few and so loosely packed that they forget how they were
/// laid in less than a second, and a run that is a hundred times as long. What it prints is right, and soon there:
/// seeds 1, 2, 3 gave S = 0.245 +- 0.009, 0.253 +- 0.013, 0.277 +- 0.013, each in 16 CPU-seconds. The box is one that
/// holds rods of 2.5 and 4.5 mm in rows at all packings up to 0.85.
inline constexpr std::string_view kStarterScene = R"({
  // A scene of Shaken. Every number may carry a unit ("4.5 mm"); without one it is in mm, s, Hz, mm/s^2.
  // Whatever is left out has the value of Sharma & Soni, Soft Matter 20, 6608 (2024).
  // `shaken validate FILE --resolved` shows the others.

  "rods": {
    "length": "4.5 mm",        // from tip to tip; longer rods order more
    "mid_diameter": "0.8 mm",
    "end_diameter": "0.4 mm",  // the taper: what makes rods move along their axis when they tilt
    "area_fraction": 0.40      // or "count": number of rods. From 0.6 on they order, and need minutes to settle
  },
  "box": {
    "side": "20 mm",           // square, periodic; the paper's is 83.73 mm
    "gap": "1.2 mm"            // between the plates
  },
  "plates": {
    "gamma": 7.0,              // largest acceleration of the plates over gravity; or "amplitude"
    "frequency": "200 Hz"
  },
  // The length of a time step: "draft" 32 us, a first look; "desk" 16 us, averages within 1 % at 0.6 of the cost;
  // "paper" 4 us, as in the paper; "fine" 2 us with impacts at their instant. Or "step" below.
  "accuracy": "paper",
  "time": {
    "steady": "auto",          // when measuring begins: a time, or "auto" to find it from S(t) afterwards
    "measure": "100 s",
    "seed": 1
  },

  // Each block switches on what it names; remove what you do not need, and its work is not done.
  "measure": {
    "order": { "every": "10 ms" },     // S(t)
    "angles": {},                      // P(theta)
    "tilt": {},                        // velocity along the rod against its tilt
    "defects": { "every": "100 ms" }   // +1/2 and -1/2
  },
  "trajectory": { "every": "100 ms" },  // trajectory.h5, for movies and your own analysis
  "stream": { "rate": "20 Hz" }        // live state over LCM, for `shaken watch`
  // , "movie": { "every": "500 ms", "size": [1280, 720] }
}
)";

}  // namespace shaken::client
