#include "scene/keys/settings.h"

#include <algorithm>
#include <string_view>

#include "base/keys/units.h"

namespace shaken::scene {

namespace {

void put_everything_at(const Place& place, Node& node) {
  node.place = place;
  for (Node& item : node.items) put_everything_at(place, item);
  for (Member& member : node.members) {
    member.place = place;
    put_everything_at(place, member.value);
  }
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Cuts at the commas that are outside of brackets and quotes.
std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\' && i + 1 < text.size()) {
      parts.back() += c;
      parts.back() += text[++i];
      continue;
    }
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == '[' || c == '{')) ++depth;
    if (!quoted && (c == ']' || c == '}')) --depth;
    if (c == ',' && depth == 0 && !quoted) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

Node json_or_bare(const std::string& text, const Place& place, std::vector<Problem>& problems) {
  std::vector<Problem> as_json;
  std::optional<Node> node = parse_document(text, *place.file, as_json);
  if (!node) {
    node.emplace();
    node->kind = Node::Kind::kString;
    node->text = trimmed(text);
  }
  put_everything_at(place, *node);
  if (node->kind != Node::Kind::kString) {
    for (const Problem& duplicate : as_json) problems.push_back(problem_at(place, {}, duplicate.message));
  }
  return *node;
}

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "1.3 mm" where the two values "1" and "3 mm" may well be one number with a decimal comma; empty otherwise.
std::string with_a_point(const std::vector<std::string>& parts) {
  if (parts.size() != 2) return {};
  const std::string first = trimmed(parts[0]);
  const std::size_t end = parts[1].find_first_not_of("0123456789");
  if (!is_digits(first) || end == 0 || end == std::string::npos) return {};
  const std::string unit = trimmed(parts[1].substr(end));
  const bool is_unit = std::any_of(units().begin(), units().end(), [&](const Unit& one) { return one.name == unit; });
  return is_unit ? first + "." + parts[1] : std::string();
}

}  // namespace

std::optional<Setting> parse_setting(const std::string& text, std::vector<Problem>& problems) {
  const Place place{std::make_shared<const std::string>("-s " + text), 0, 0};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || trimmed(text.substr(0, equals)).empty()) {
    problems.push_back(problem_at(place, {}, "expected path=value, for example rods.length=2.5"));
    return std::nullopt;
  }
  Setting setting{trimmed(text.substr(0, equals)), place, {}};
  const std::vector<std::string> parts = split_at_commas(text.substr(equals + 1));
  if (const std::string number = with_a_point(parts); !number.empty()) {
    const std::string unit = number.substr(number.find_first_not_of("0123456789."));
    problems.push_back(problem_at(place, setting.path,
                                  "one number with a decimal comma, or two values? Write " + number + ", or " +
                                      trimmed(parts[0]) + unit + "," + parts[1]));
    return std::nullopt;
  }
  if (parts.size() == 1) {
    setting.value = json_or_bare(parts.front(), place, problems);
  } else {
    setting.value.kind = Node::Kind::kArray;
    setting.value.place = place;
    for (const std::string& part : parts) setting.value.items.push_back(json_or_bare(part, place, problems));
  }
  return setting;
}

}  // namespace shaken::scene
