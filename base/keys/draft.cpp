#include "base/keys/draft.h"

#include <fmt/format.h>

#include <utility>

#include "base/core/check.h"

namespace shaken::keys {

Draft::Draft(const Rules& table, Place place) : table_(table), place_(std::move(place)), given_(table.rules().size()) {}

void Draft::read(const Node& text, std::vector<Problem>& problems) {
  if (text.kind != Node::Kind::kObject) {
    problems.push_back(problem_at(text.place, {}, fmt::format("expected an object, not {}", describe(text))));
    return;
  }
  read_members({}, text, problems);
  for (std::size_t i = 0; i < given_.size(); ++i) {
    const Rule& rule = *table_.rules()[i];
    if (rule.required && !given_[i]) {
      problems.push_back(problem_at(text.place, {}, fmt::format("\"{}\" is missing. {}", rule.path, rule.doc)));
    }
  }
}

void Draft::read_members(std::string_view path, const Node& object, std::vector<Problem>& problems) {
  for (const Member& member : object.members) {
    if (path.empty() && is_link_to_schema(member, problems)) continue;
    const std::string inner = path.empty() ? member.key : fmt::format("{}.{}", path, member.key);
    // A dot in a key would be taken for a step into an object.
    if (member.key.empty() || member.key.find('.') != std::string::npos) {
      problems.push_back(problem_at(
          member.place, inner,
          fmt::format("unknown key \"{}\"{}", member.key, table_.index(inner) < 0 ? "" : "; use objects in objects")));
      continue;
    }
    assign(inner, member.place, member.value, problems);
  }
}

void Draft::assign(std::string_view path, const Place& key, const Node& node, std::vector<Problem>& problems) {
  const int found = table_.index(path);
  if (found < 0 && !table_.is_group(path)) {
    problems.push_back(
        problem_at(key, path, "unknown key" + suggestion(problems, [&] { return table_.suggest_path(path); })));
    return;
  }
  const Rule* rule = found >= 0 ? table_.rules()[static_cast<std::size_t>(found)] : nullptr;
  if (rule && rule->form != Form::kBlock) {
    auto& slot = given_[static_cast<std::size_t>(found)];
    if (node.kind == Node::Kind::kNull) {
      slot.reset();
      return;
    }
    slot = read_value(*rule, node, problems);
    const int block = table_.block_of(static_cast<std::size_t>(found));
    if (block >= 0 && !is_on(static_cast<std::size_t>(block))) {
      given_[static_cast<std::size_t>(block)] = Given{true, key, true};
    }
    return;
  }

  clear_beneath(path);
  const bool is_object = node.kind == Node::Kind::kObject;
  if (found >= 0) {
    const bool on = is_object || (node.kind == Node::Kind::kBoolean && node.boolean);
    given_[static_cast<std::size_t>(found)] = Given{on, node.place, true};
  }
  const bool may_be_boolean = found >= 0 && node.kind == Node::Kind::kBoolean;
  if (is_object) {
    read_members(path, node, problems);
  } else if (node.kind != Node::Kind::kNull && !may_be_boolean) {
    problems.push_back(problem_at(node.place, path, fmt::format("expected an object, not {}", describe(node))));
  }
}

void Draft::clear_beneath(std::string_view path) {
  for (std::size_t i = 0; i < given_.size(); ++i) {
    const Rule& rule = *table_.rules()[i];
    if (!is_beneath(rule.path, path)) continue;
    given_[i].reset();
    if (rule.form == Form::kBlock) given_[i] = Given{false, place_, true};
  }
}

const Given* Draft::find(std::size_t index) const { return given_[index] ? &*given_[index] : nullptr; }

const Given* Draft::find(std::string_view path) const {
  const int index = table_.index(path);
  SHAKEN_CHECK(index >= 0, std::string(path));
  return find(static_cast<std::size_t>(index));
}

bool Draft::is_ok(std::string_view path) const {
  const Given* given = find(path);
  return !given || given->ok;
}

bool Draft::is_on(std::string_view block) const { return is_on(static_cast<std::size_t>(table_.index(block))); }

bool Draft::is_on(std::size_t block) const {
  const Given* given = find(block);
  return std::get<bool>(given ? given->value : table_.rules()[block]->fallback);
}

}  // namespace shaken::keys
