#pragma once

#include <array>
#include <random>
#include <string>
#include <string_view>

/// Texts that are nearly a scene or a sweep.
namespace shaken::scene {

inline constexpr std::string_view kScene = R"({ // a comment
  "rods":  { "length": "4.5 mm", "mid_diameter": 0.8, "end_diameter": "400 um", "beads": 15, "area_fraction": 0.5 },
  "box":   { "side": "40 mm", "gap": 1.2 }, "plates": { "gamma": 7.0, "frequency": "200 Hz" }, "gravity": "9.81 m/s^2",
  "contacts": { "rod_rod": { "friction": 0.05, "restitution": 0.3 }, "law": "newton", "sweeps": 2 },
  "time":  { "step": "4 us", "steady": "auto", "measure": "6000 s", "seed": 1 }, /* more */
  "measure": { "order": {"every": "10 ms"}, "g2": {}, "msd": null, "defects": {"grid": 1} },
  "stream": { "rate": "20 Hz" }, "movie": { "every": "50 ms", "size": [1280, 720] } })";

inline constexpr std::string_view kSweep = R"({ "name": "x", "scene": { "box": {"side": 40} }, "sweep": {
  "grid": { "rods.length": [2.5, "3.5 mm"], "rods.area_fraction": "0.45:0.55:0.1" },
  "zip": { "box.gap": [1.2, 1.4], "plates.gamma": {"from": 6, "to": 7, "n": 2} },
  "list": [ {"time.step": "2 us"} ], "stages": [ {"time.measure": "2 s"} ],
  "replicas": 2 } })";

inline constexpr std::string_view kSweeps = R"({ "$schema": "sweep.schema.json", "scene": { "box": {"side": 40} },
  "sweep": [ { "grid": { "rods.length": {"from": 2.5, "to": "3.5 mm", "n": 2, "scale": "linear"} } },
             { "zip": { "contacts.sweeps": [1, 4], "box.gap": {"from": 1.2, "to": 1.4, "step": 0.2} } },
             { "grid": { "time.step": {"from": "1 us", "to": "4 us", "n": 3, "scale": "log"} } } ] })";

inline constexpr auto kPieces = std::to_array<std::string_view>(
    {"{",  "}",     "[",    "]",      ",",       ":",          "\"",        "\\",       "/*",
     "*/", "//",    "\n",   " ",      "0",       "9",          "-",         ".",        "e",
     "e9", "1e308", "null", "true",   "NaN",     "mm",         " us",       "\"rods\"", "\"length\":",
     "{}", "[]",    "\xff", "\u00b5", "0:1:0.1", "\"sweep\":", "\"grid\":", "1",        "999999999999999999",
     "-0"});

/// `original` with a few pieces cut out, doubled, swapped or put in.
inline std::string mutated(std::string_view original, std::mt19937_64& random) {
  std::string text(original);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (std::size_t n = 1 + below(4); n > 0 && !text.empty(); --n) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(below(4) == 0 ? 60 : 4);
    switch (below(5)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 2:
        text.insert(at, kPieces[below(kPieces.size())]);
        break;
      case 3:
        text[at] = static_cast<char>(random() % 256);
        break;
      default:
        text.replace(at, length, kPieces[below(kPieces.size())]);
        break;
    }
  }
  return text;
}

}  // namespace shaken::scene
