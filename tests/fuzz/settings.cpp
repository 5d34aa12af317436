// Settings "path=value", one a line, on top of an empty scene and as axes of a sweep.
#include "scene/keys/settings.h"

#include <algorithm>
#include <string>
#include <vector>

#include "scene/keys/values.h"
#include "scene/load.h"
#include "scene/sweeps/sweep.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> settings(1);
  for (const char c : fuzz::text_of(data, size)) {
    if (c == '\n') {
      settings.emplace_back();
    } else {
      settings.back() += c;
    }
  }
  std::vector<keys::Problem> problems;
  scene::Room room{1000};
  std::size_t n_points = 1;
  for (const std::string& text : settings) {
    const std::size_t before = problems.size();
    const auto setting = scene::parse_setting(text, problems);
    fuzz::promise(setting || problems.size() > before, "a refusal says why");
    if (!setting || scene::field_index(setting->path) < 0) continue;
    n_points *= std::max<std::size_t>(
        1, scene::read_values(scene::field_at(setting->path), setting->value, room, problems).size());
    n_points = std::min<std::size_t>(n_points, 1000);
  }
  (void)scene::load_scene("{}", "fuzz.json", settings);
  // every point is a scene: many take their time
  if (n_points <= 8 && room.left > 0) (void)scene::load_sweep("{}", "fuzz.json", settings);
  return 0;
}
