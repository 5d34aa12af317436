#include "base/keys/rules.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/keys/markdown.h"
#include "base/keys/nearest.h"

namespace shaken::keys {

namespace {

/// Everything but the last name of a dotted path.
std::string_view parent_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot);
}

std::string_view last_name(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

}  // namespace

void Rules::set(std::vector<const Rule*> rules) {
  rules_ = std::move(rules);
  for (std::size_t i = 0; i < rules_.size(); ++i) by_path_.emplace(rules_[i]->path, static_cast<int>(i));
  for (const Rule* rule : rules_) blocks_.push_back(block_around(rule->path));
}

int Rules::index(std::string_view path) const {
  const auto found = by_path_.find(path);
  return found == by_path_.end() ? -1 : found->second;
}

bool Rules::is_group(std::string_view path) const {
  return index(path) < 0 &&
         std::any_of(rules_.begin(), rules_.end(), [&](const Rule* rule) { return is_beneath(rule->path, path); });
}

std::vector<std::string> Rules::names_in(std::string_view path) const {
  std::vector<std::string> names;
  for (const Rule* rule : rules_) {
    if (!is_beneath(rule->path, path)) continue;
    const std::string_view rest = std::string_view(rule->path).substr(path.empty() ? 0 : path.size() + 1);
    const std::string name(rest.substr(0, rest.find('.')));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

int Rules::block_around(std::string_view path) const {
  for (std::string_view outer = parent_of(path); !outer.empty(); outer = parent_of(outer)) {
    if (const int found = index(outer); found >= 0) return found;
  }
  return -1;
}

std::string Rules::suggest_path(std::string_view path) const {
  // A slip in the last name only: what could stand beside it.
  const std::string_view parent = parent_of(path);
  if (parent.empty() || is_group(parent) || index(parent) >= 0) {
    const std::string name = nearest(last_name(path), names_in(parent));
    if (!name.empty()) return did_you_mean(parent.empty() ? name : fmt::format("{}.{}", parent, name));
  }
  // The right name in the wrong place, or slips elsewhere.
  std::vector<std::string> paths;
  std::string same_name;
  for (const Rule* rule : rules_) {
    paths.push_back(rule->path);
    if (same_name.empty() && last_name(rule->path) == last_name(path)) same_name = rule->path;
  }
  const std::string whole_path = nearest(path, paths);
  return did_you_mean(whole_path.empty() ? same_name : whole_path);
}

std::string Rules::as_markdown(std::string_view path) const {
  std::string table = table_head({"key", "meaning", "unit", "allowed", "default"});
  for (const Rule* rule : rules_) {
    if (!is_beneath(rule->path, path)) continue;
    table += table_line(
        {"`" + rule->path + "`", rule->doc, default_unit(rule->dimension), allowed(*rule), fallback_of(*rule)});
  }
  return table;
}

bool is_beneath(std::string_view path, std::string_view outer) {
  return outer.empty() || (path.size() > outer.size() && path.starts_with(outer) && path[outer.size()] == '.');
}

}  // namespace shaken::keys
