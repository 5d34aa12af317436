#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/keys/keys.h"

namespace shaken::scene {

/// A change to a scene from the command line: "rods.length=2.5 mm", "movie.size=[640,480]", "measure.msd={}".
struct Setting {
  std::string path;  ///< dotted
  Place place;       ///< "-s rods.length=2.5 mm"
  Node value;        ///< several values, "2.5,3.5", are an array
};

/// Takes "path=value" apart. The value is JSON where it reads as JSON, otherwise bare text. None, with a problem, if
/// there is no "=".
std::optional<Setting> parse_setting(const std::string& text, std::vector<Problem>& problems);

}  // namespace shaken::scene
