#include "web/examples.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "base/files.h"
#include "client/starter_scene.h"

namespace shaken::web {

Json examples(const std::filesystem::path& configs) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(configs, error)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Json scenes = Json::array({{{"name", "a small box"}, {"text", client::kStarterScene}}});
  for (const auto& file : files) {
    if (const auto text = read_file(file)) scenes.push_back({{"name", file.stem().string()}, {"text", *text}});
  }
  return scenes;
}

}  // namespace shaken::web
