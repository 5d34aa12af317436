// SPDX-License-Identifier: MIT
#include "client/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "base/failure.h"
#include "base/text.h"
#include "scene/nearest.h"

namespace shaken::client {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

constexpr const char* kProgram = "versions.shaken";
constexpr const char* kPhysics = "versions.physics";

/// Fields that name a row rather than measure something; never averaged.
const std::set<std::string> kNames{"job", "sweep", "state", "label", "replica", kProgram, kPhysics};

/// Puts the scalars of `object` into `fields`, members of members as "outer.inner".
void flatten(const Json& object, const std::string& prefix, Json& fields) {
  for (const auto& [key, value] : object.items()) {
    std::string name = prefix;
    if (!prefix.empty()) name += '.';
    name += key;
    if (value.is_object()) {
      flatten(value, name, fields);
    } else if (value.is_primitive() && !value.is_null()) {
      fields[name] = value;
    }
  }
}

/// A number, or one at the beginning of a text that goes on with a unit.
double leading_number(const Json& value) {
  if (value.is_number()) return value.get<double>();
  if (!value.is_string()) return kNoNumber;
  const std::string text = value.get<std::string>();
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end == text.c_str() ? kNoNumber : number;
}

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
}

bool ends_with(std::string_view text, std::string_view end) {
  return text == end || (text.size() > end.size() && text.ends_with(end) && text[text.size() - end.size() - 1] == '.');
}

/// What every one of `done` (replicas of one point) tells, put together into `point`.
void average(const std::vector<ResultRow>& done, ResultRow& point) {
  const std::vector<std::string> names = field_names(done);
  std::set<std::string> own_errors;
  for (const std::string& name : names) own_errors.insert(own_error_field(name));
  for (const std::string& name : names) {
    if (kNames.contains(name) || point.parameters.contains(name) || own_errors.contains(name)) continue;
    std::vector<double> values, sems;
    bool all_steady = true;
    std::size_t n_told = 0;
    for (const ResultRow& row : done) {
      const auto value = row.fields.find(name);
      if (value == row.fields.end()) continue;
      ++n_told;
      if (value->is_boolean()) all_steady &= value->get<bool>();
      if (!value->is_number()) continue;
      values.push_back(value->get<double>());
      sems.push_back(standard_error(row, name));
    }
    if (ends_with(name, "steady")) {
      if (!all_steady) {
        point.fields[name] = false;
      } else if (n_told == done.size()) {
        point.fields[name] = true;
      }
    }
    if (values.size() < done.size()) continue;
    if (ends_with(name, "n_effective")) {
      point.fields[name] = std::accumulate(values.begin(), values.end(), 0.0);
      continue;
    }
    const Estimate result = replica_mean(values, sems);
    point.fields[name] = result.value;
    if (std::isfinite(result.sem)) point.fields[name + ":sem"] = result.sem;
  }
}

}  // namespace

std::string own_error_field(const std::string& field) {
  if (field == "order.mean") return "order.sem";
  static constexpr std::string_view kValue = ".value";
  if (!field.ends_with(kValue)) return {};
  return field.substr(0, field.size() - kValue.size()) + ".sem";
}

double standard_error(const ResultRow& row, const std::string& field) {
  if (row.fields.contains(field + ":sem")) return row.number(field + ":sem");
  return row.number(own_error_field(field));
}

bool still_relaxes(const ResultRow& row, const std::string& field) {
  const bool is_average = field == "order.mean" || field == "order.std" || field.starts_with("defects.mean") ||
                          (field.starts_with("measured.") && field.ends_with(".value"));
  if (!is_average) return false;
  for (const std::string& told : {field.substr(0, field.rfind('.')) + ".steady", std::string("steady")}) {
    const auto steady = row.fields.find(told);
    if (steady != row.fields.end() && steady->is_boolean()) return !steady->get<bool>();
  }
  return false;
}

std::string resolved_field(const std::vector<ResultRow>& rows, const std::string& word) {
  const std::vector<std::string> names = field_names(rows);
  for (const std::string& name : {word, "measured." + word + ".value"}) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  }
  throw Failure(ExitCode::kBadInput,
                fmt::format("no row has a field '{}'{}", word, scene::did_you_mean(scene::nearest(word, names))));
}

double ResultRow::number(const std::string& field) const {
  const auto value = fields.find(field);
  return value == fields.end() ? kNoNumber : leading_number(*value);
}

ResultRow result_row(const Json& row) {
  ResultRow result;
  result.source = row;
  result.parameters = row.at("parameters");
  result.state = row.at("state").get<std::string>();
  for (const char* key : {"job", "sweep", "state", "label"}) result.fields[key] = text_of(row, key);
  // By name and value, not by flatten: a path holds dots of its own.
  for (const auto& [path, value] : result.parameters.items()) result.fields[path] = value;
  result.fields["replica"] = row.value("replica", 0);
  const auto summary = row.find("summary");
  if (summary != row.end() && summary->is_object()) flatten(*summary, "", result.fields);
  return result;
}

std::vector<ResultRow> result_rows(ApiClient& session, const Target& target) {
  const Json answer = session.get("/v1/results?sweep=" + url_encoded(target.sweep_id()));
  std::vector<ResultRow> rows;
  for (const Json& row : answer.at("rows")) {
    if (target.is_sweep || row.at("job") == target.answer.at("job").at("id")) rows.push_back(result_row(row));
  }
  return rows;
}

Condition::Condition(const std::string& text) {
  const auto begin = text.find_first_of("<>=!");
  const auto end = begin == std::string::npos ? begin : text.find_first_not_of("<>=!", begin);
  if (end != std::string::npos) {
    field_ = trimmed(text.substr(0, begin));
    comparison_ = text.substr(begin, end - begin);
    value_ = trimmed(text.substr(end));
  }
  static const std::set<std::string> kComparisons{"<", "<=", ">", ">=", "=", "==", "!="};
  if (field_.empty() || value_.empty() || !kComparisons.contains(comparison_)) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("'{}' is no comparison: write FIELD OP VALUE with OP one of < <= > >= "
                              "= !=, for example 'rods.area_fraction>0.6'",
                              text));
  }
}

bool Condition::matches(const ResultRow& row) const {
  const auto found = row.fields.find(field_);
  if (found == row.fields.end()) return false;
  const double left = leading_number(*found);
  const double right = leading_number(value_);
  const bool numbers = !std::isnan(left) && !std::isnan(right);
  const bool equal = numbers ? left == right : field_text(row, field_) == value_;
  if (comparison_ == "=" || comparison_ == "==") return equal;
  if (comparison_ == "!=") return !equal;
  if (!numbers) {
    throw Failure(ExitCode::kBadInput, fmt::format("{} {} {}: '{}' is no number", field_, comparison_, value_,
                                                   std::isnan(right) ? value_ : field_text(row, field_)));
  }
  if (comparison_ == "<") return left < right;
  if (comparison_ == "<=") return left <= right;
  if (comparison_ == ">") return left > right;
  return left >= right;
}

std::vector<ResultRow> filtered(const std::vector<ResultRow>& rows, std::vector<Condition> conditions) {
  if (!rows.empty()) {
    for (Condition& condition : conditions) condition.set_field(resolved_field(rows, condition.field()));
  }
  std::vector<ResultRow> kept;
  for (const ResultRow& row : rows) {
    if (std::all_of(conditions.begin(), conditions.end(), [&](const auto& c) { return c.matches(row); })) {
      kept.push_back(row);
    }
  }
  return kept;
}

std::string RowVersion::text() const {
  if (!is_known()) return "";
  return fmt::format("shaken {}, physics {}", program.empty() ? "?" : program, physics.empty() ? "?" : physics);
}

RowVersion version_of(const ResultRow& row) { return {field_text(row, kProgram), field_text(row, kPhysics)}; }

RowVersion version_of(const Json& versions) {
  const auto text = [&](const char* key) {
    const auto found = versions.is_object() ? versions.find(key) : versions.end();
    if (found == versions.end()) return std::string();
    return found->is_string() ? found->get<std::string>() : found->dump();
  };
  return {text("shaken"), text("physics")};
}

bool has_several_versions(const std::vector<ResultRow>& rows) {
  std::set<RowVersion> versions;
  for (const ResultRow& row : rows) {
    if (const RowVersion version = version_of(row); version.is_known()) versions.insert(version);
  }
  return versions.size() > 1;
}

std::vector<ResultRow> aggregated(const std::vector<ResultRow>& rows) {
  // Groups in the order in which they are first met.
  std::vector<std::vector<const ResultRow*>> groups;
  std::map<std::pair<std::string, RowVersion>, std::size_t> group_of;
  // What different versions computed is never averaged; a run that has no version yet belongs to the newest.
  std::map<std::string, RowVersion> newest_version;
  for (const ResultRow& row : rows) {
    RowVersion& newest = newest_version[row.parameters.dump()];
    newest = std::max(newest, version_of(row));
  }
  for (const ResultRow& row : rows) {
    const std::string parameters = row.parameters.dump();
    const RowVersion version = version_of(row);
    const auto key = std::pair(parameters, version.is_known() ? version : newest_version[parameters]);
    const auto [place, is_new] = group_of.try_emplace(key, groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].push_back(&row);
  }

  std::vector<ResultRow> points;
  for (const auto& group : groups) {
    ResultRow point;
    point.parameters = group.front()->parameters;
    for (const auto& [path, value] : point.parameters.items()) point.fields[path] = value;
    point.fields["n_replicas"] = group.size();
    std::vector<ResultRow> done;
    for (const ResultRow* row : group) {
      if (row->state == "done") done.push_back(*row);
    }
    point.fields["n_done"] = done.size();
    for (const char* version : {kProgram, kPhysics}) {
      if (!done.empty() && done.front().fields.contains(version)) point.fields[version] = done.front().fields[version];
    }
    point.state = done.size() == group.size() ? "done" : "partial";
    average(done, point);
    points.push_back(std::move(point));
  }
  return points;
}

std::vector<std::string> field_names(const std::vector<ResultRow>& rows) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const ResultRow& row : rows) {
    for (const auto& [name, value] : row.fields.items()) {
      if (seen.insert(name).second) names.push_back(name);
    }
  }
  return names;
}

std::vector<std::string> swept_parameters(const std::vector<ResultRow>& rows) {
  std::vector<std::string> swept;
  std::map<std::string, std::set<std::string>> values;
  std::vector<std::string> order;
  for (const ResultRow& row : rows) {
    for (const auto& [path, value] : row.parameters.items()) {
      if (values[path].empty()) order.push_back(path);
      values[path].insert(value.dump());
    }
  }
  for (const std::string& path : order) {
    if (values[path].size() > 1) swept.push_back(path);
  }
  return swept;
}

std::string field_text(const ResultRow& row, const std::string& field) {
  const auto value = row.fields.find(field);
  if (value == row.fields.end()) return {};
  return printable(value->is_string() ? value->get<std::string>() : value->dump());
}

std::string to_csv(const std::vector<ResultRow>& rows, std::vector<std::string> fields) {
  const std::vector<std::string> names = fields.empty() ? field_names(rows) : std::move(fields);
  std::string csv;
  const auto add_line = [&csv, &names](auto text_of_name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (i > 0) csv += ',';
      csv += csv_field(text_of_name(names[i]));
    }
    csv += '\n';
  };
  if (names.empty()) return csv;
  add_line([](const std::string& name) { return printable(name); });
  for (const ResultRow& row : rows) {
    add_line([&row](const std::string& name) { return field_text(row, name); });
  }
  return csv;
}

}  // namespace shaken::client
