// SPDX-License-Identifier: MIT
#include "scene/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "base/core/check.h"
#include "scene/nearest.h"

namespace shaken::scene {

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

int field_index(std::string_view path) {
  static const auto index = [] {
    std::unordered_map<std::string_view, int> by_path;
    for (std::size_t i = 0; i < fields().size(); ++i) by_path.emplace(fields()[i].path, static_cast<int>(i));
    return by_path;
  }();
  const auto found = index.find(path);
  return found == index.end() ? -1 : found->second;
}

const Field& field_at(std::string_view path) {
  const int index = field_index(path);
  SHAKEN_CHECK(index >= 0, std::string(path));
  return fields()[static_cast<std::size_t>(index)];
}

bool is_beneath(std::string_view path, std::string_view outer) {
  return outer.empty() || (path.size() > outer.size() && path.starts_with(outer) && path[outer.size()] == '.');
}

bool is_group(std::string_view path) {
  return field_index(path) < 0 && std::any_of(fields().begin(), fields().end(),
                                              [&](const Field& field) { return is_beneath(field.path, path); });
}

std::vector<std::string> names_in(std::string_view path) {
  std::vector<std::string> names;
  for (const Field& field : fields()) {
    if (!is_beneath(field.path, path)) continue;
    const std::string_view rest = std::string_view(field.path).substr(path.empty() ? 0 : path.size() + 1);
    const std::string name(rest.substr(0, rest.find('.')));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::string_view block_around(std::string_view path) {
  for (std::string_view outer = parent_of(path); !outer.empty(); outer = parent_of(outer)) {
    const int index = field_index(outer);
    if (index >= 0) return fields()[static_cast<std::size_t>(index)].path;
  }
  return {};
}

const Field* block_of(const Field& field) {
  static const auto blocks = [] {
    std::vector<const Field*> all;
    for (const Field& each : fields()) {
      const int index = field_index(block_around(each.path));
      all.push_back(index < 0 ? nullptr : &fields()[static_cast<std::size_t>(index)]);
    }
    return all;
  }();
  return blocks[static_cast<std::size_t>(&field - fields().data())];
}

std::string suggest_path(std::string_view path) {
  // A slip in the last name only: what could stand beside it.
  const std::string_view parent = parent_of(path);
  if (parent.empty() || is_group(parent) || field_index(parent) >= 0) {
    const std::string name = nearest(last_name(path), names_in(parent));
    if (!name.empty()) return did_you_mean(parent.empty() ? name : fmt::format("{}.{}", parent, name));
  }
  // The right name in the wrong place, or slips elsewhere.
  std::vector<std::string> paths;
  std::string same_name;
  for (const Field& field : fields()) {
    paths.push_back(field.path);
    if (same_name.empty() && last_name(field.path) == last_name(path)) same_name = field.path;
  }
  const std::string whole_path = nearest(path, paths);
  return did_you_mean(whole_path.empty() ? same_name : whole_path);
}

bool is_allowed(const Field& field, double value) {
  return (value >= field.low && value <= field.high) || (field.or_zero && value == 0);
}

std::string range_of(const Field& field) {
  return (field.or_zero ? "0 or " : "") + format_range(field.low, field.high, field.dimension);
}

std::string show(const Field& field, const Value& value) {
  if (const bool* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const double* number = std::get_if<double>(&value)) return format_quantity(*number, field.dimension);
  if (const std::string* name = std::get_if<std::string>(&value)) return fmt::format("\"{}\"", *name);
  if (const auto* size = std::get_if<std::array<double, 2>>(&value)) {
    return fmt::format("[{}, {}]", (*size)[0], (*size)[1]);
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    std::string text;
    for (const double number : *numbers)
      text += fmt::format("{}{}", text.empty() ? "" : ", ", format_quantity(number, field.dimension));
    return "[" + text + "]";
  }
  return "none";
}

std::string fields_as_markdown() {
  std::string table = "| key | meaning | unit | allowed | default |\n|---|---|---|---|---|\n";
  for (const Field& field : fields()) {
    std::string allowed;
    for (const std::string& name : field.names)
      allowed += fmt::format("{}`\"{}\"`", allowed.empty() ? "" : " or ", name);
    if (field.form == Form::kBlock) {
      allowed = "object or `null`";
    } else if (field.form == Form::kSwitch) {
      allowed = "`true` or `false`";
    } else if (field.form == Form::kRunId) {
      allowed = "16 hex digits";
    } else if (field.form == Form::kNumbers) {
      allowed = "list of " + range_of(field);
    } else if (field.form != Form::kName) {
      const std::string range = field.form == Form::kWhole
                                    ? fmt::format("whole, {:.16g} to {:.16g}", field.low, field.high)
                                    : range_of(field);
      allowed += (allowed.empty() ? "" : " or ") + range;
    }
    const std::string unit(default_unit(field.dimension));
    const std::string fallback = field.fallback_note.empty() ? show(field, field.fallback) : field.fallback_note;
    table += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.path, field.doc, unit, allowed, fallback);
  }
  return table;
}

}  // namespace shaken::scene
