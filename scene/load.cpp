#include "scene/load.h"

#include <fmt/format.h>

#include <optional>

#include "base/keys/draft.h"
#include "scene/keys/keys.h"
#include "scene/keys/settings.h"
#include "scene/keys/values.h"
#include "scene/resolve/resolve.h"

namespace shaken::scene {

namespace {

void apply(const Setting& setting, Draft& draft, std::vector<Problem>& problems) {
  const int index = field_index(setting.path);
  if (index < 0) return draft.assign(setting.path, setting.place, setting.value, problems);
  Room room;
  const std::vector<Node> values =
      read_values(fields()[static_cast<std::size_t>(index)], setting.value, room, problems);
  if (values.size() > 1) {
    problems.push_back(problem_at(setting.place, setting.path,
                                  fmt::format("{} values make a sweep; a single scene takes one", values.size())));
  } else if (values.size() == 1) {
    draft.assign(setting.path, setting.place, values.front(), problems);
  }
}

}  // namespace

Loaded<RunPlan> load_scene(std::string_view text, const std::string& file, std::span<const std::string> settings) {
  std::vector<Problem> problems;
  const std::optional<Node> root = parse_document(text, file, problems);
  if (!root) return problems;
  if (const Member* sweep = root->find("sweep"); sweep || (sweep = root->find("scene"))) {
    problems.push_back(problem_at(sweep->place, sweep->key,
                                  "this is a sweep file, for `shaken submit`; a single scene is wanted here"));
    return tidied(problems);
  }
  Draft draft(fields(), root->place);
  draft.read(*root, problems);
  for (const std::string& written : settings) {
    if (const auto setting = parse_setting(written, problems)) apply(*setting, draft, problems);
  }
  std::optional<RunPlan> plan = resolve(draft, problems);
  if (!problems.empty()) return tidied(problems);
  return std::move(plan).value();
}

}  // namespace shaken::scene
