#include "scene/deciding_key.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <sstream>
#include <variant>

#include "scene/keys/fields.h"

namespace shaken::scene {
namespace {

/// Whether a key has a value with which no effect is on.
bool is_neutral(const Field& key, const Value& value) {
  return value == Value(0.0) || value == Value(false) || value == Value(std::vector<double>()) ||
         (key.form == Form::kName && value == Value(key.names.front()));
}

}  // namespace

std::string deciding_key(const RunPlan& plan, std::string_view keys) {
  std::string neutral, absent;
  std::istringstream patterns{std::string(keys)};
  for (std::string pattern; patterns >> pattern;) {
    for (const Field& key : fields()) {
      if (fnmatch(pattern.c_str(), key.path.c_str(), 0) != 0) continue;
      const Value value = fields().value(plan, key);
      const Field* block = fields().block_of(key);
      if (absent.empty()) absent = (block == nullptr ? key : *block).path + " is absent";
      if (std::holds_alternative<std::monostate>(value)) continue;
      const char* space = key.unit.empty() ? "" : " ";
      std::string text = fmt::format("{} = {}{}{}", key.path, show(key, value), space, key.unit);
      if (!is_neutral(key, value)) return text;
      if (neutral.empty()) neutral = text;
    }
  }
  return neutral.empty() ? absent : neutral;
}

}  // namespace shaken::scene
