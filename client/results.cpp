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
#include "base/files.h"
#include "base/keys/nearest.h"
#include "base/text.h"
#include "run/files/directory.h"
#include "scene/canonical.h"
#include "scene/fields.h"
#include "scene/load.h"

namespace shaken::client {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

constexpr const char* kProgram = "versions.shaken";
constexpr const char* kPhysics = "versions.physics";

/// Fields that name a row rather than measure something; never averaged.
const std::set<std::string> kNames{"job", "sweep", "state", "label", "replica", "directory", kProgram, kPhysics};

/// Puts the scalars of `object` into `fields`, members of members as "outer.inner".
void flatten(const Json& object, const std::string& prefix, Json& fields) {
  for (const auto& [key, value] : object.items()) {
    if (prefix.empty() && key == "why_null") continue;  // words about other fields
    std::string name = prefix;
    if (!prefix.empty()) name += '.';
    name += key;
    if (value.is_object()) {
      flatten(value, name, fields);
    } else if (value.is_primitive() && !(value.is_null() && prefix.empty() && key != "steady")) {
      fields[name] = value;  // null too, but of a whole block that was not measured: there is no value to be had
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

bool ends_with(std::string_view text, std::string_view end) {
  return text == end || (text.size() > end.size() && text.ends_with(end) && text[text.size() - end.size() - 1] == '.');
}

/// The keys of their scenes that all of `done` have alike.
void take_common_keys(const std::vector<ResultRow>& done, ResultRow& point) {
  if (done.empty()) return;
  for (const auto& [path, value] : done.front().scene.items()) {
    // Those that differ (time.seed) are nothing to average either.
    point.scene[path] = value;
    const bool all_alike = std::all_of(done.begin(), done.end(), [&path = path, &value = value](const ResultRow& row) {
      return row.scene.contains(path) && row.scene[path] == value;
    });
    if (all_alike) point.fields[path] = value;
  }
}

/// What all of `done` (replicas of one point) have measured, put together into `point`.
void average(const std::vector<ResultRow>& done, ResultRow& point) {
  const std::vector<std::string> names = field_names(done);
  std::set<std::string> own_errors;
  for (const std::string& name : names) own_errors.insert(own_error_field(name));
  for (const std::string& name : names) {
    if (kNames.contains(name) || point.parameters.contains(name) || point.scene.contains(name) ||
        own_errors.contains(name) || ends_with(name, "sem_if_steady"))
      continue;
    std::vector<double> values, sems;
    bool all_steady = true;
    std::size_t n_known = 0;
    for (const ResultRow& row : done) {
      const auto value = row.fields.find(name);
      if (value == row.fields.end() || value->is_null()) continue;
      ++n_known;
      if (value->is_boolean()) all_steady &= value->get<bool>();
      if (!value->is_number()) continue;
      values.push_back(value->get<double>());
      sems.push_back(standard_error(row, name));
    }
    if (ends_with(name, "steady")) {
      if (!all_steady) {
        point.fields[name] = false;
      } else {
        point.fields[name] = n_known == done.size() ? Json(true) : Json(nullptr);
      }
      continue;
    }
    if (values.empty()) {
      if (n_known == 0) point.fields[name] = nullptr;
      continue;
    }
    if (ends_with(name, "over_s")) {  // a setting, which replicas share
      point.fields[name] = values.front();
      continue;
    }
    if (values.size() < done.size()) point.fields[name + ":n"] = values.size();
    if (ends_with(name, "n_effective")) {
      point.fields[name] = std::accumulate(values.begin(), values.end(), 0.0);
      continue;
    }
    const Estimate result = replica_mean(values, sems);
    point.fields[name] = result.value;
    if (std::isfinite(result.sem)) point.fields[error_field(name)] = result.sem;
  }
}

}  // namespace

std::string own_error_field(const std::string& field) {
  if (field == "order.mean") return "order.sem";
  static constexpr std::string_view kValue = ".value";
  if (!field.ends_with(kValue)) return {};
  return field.substr(0, field.size() - kValue.size()) + ".sem";
}

std::string error_field(const std::string& field) {
  const std::string own = own_error_field(field);
  return own.empty() ? field + ":sem" : own;
}

double standard_error(const ResultRow& row, const std::string& field) { return row.number(error_field(field)); }

Steadiness steadiness(const ResultRow& row, const std::string& field) {
  const bool is_average = field == "order.mean" || field == "order.std" || field.starts_with("defects.mean") ||
                          (field.starts_with("measured.") && field.ends_with(".value"));
  const auto value = row.fields.find(field);
  if (!is_average || value == row.fields.end() || !value->is_number()) return Steadiness::kSteady;
  bool is_there = false;
  for (const std::string& name : {field.substr(0, field.rfind('.')) + ".steady", std::string("steady")}) {
    const auto steady = row.fields.find(name);
    if (steady == row.fields.end()) continue;
    is_there = true;
    if (steady->is_boolean()) return steady->get<bool>() ? Steadiness::kSteady : Steadiness::kRelaxing;
  }
  return is_there ? Steadiness::kNotKnown : Steadiness::kSteady;
}

std::optional<std::string> field_named(std::span<const std::string> names, const std::string& word) {
  const auto is_there = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::string known_as_s = word == "S" ? "order.mean" : word;  // as in tables and figures
  for (const std::string& name : {word, "measured." + word + ".value", known_as_s}) {
    if (is_there(name)) return name;
  }
  for (const std::string_view end : {".sem", ":sem"}) {
    if (!word.ends_with(end)) continue;
    const auto of = field_named(names, word.substr(0, word.size() - end.size()));
    if (of && is_there(error_field(*of))) return error_field(*of);
  }
  return std::nullopt;
}

namespace {

/// The field that `word` is a slip of, by its short name if it has one: "dip" of "measured.dip.value". Else the first
/// that begins with it, as `theta_m_deg` does with "theta_m".
std::string nearest_field(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::string_view kBefore = "measured.", kAfter = ".value";
  std::vector<std::string> candidates;
  for (const std::string& name : names) {
    const bool is_measured = name.starts_with(kBefore) && name.ends_with(kAfter);
    candidates.push_back(is_measured ? name.substr(kBefore.size(), name.size() - kBefore.size() - kAfter.size())
                                     : name);
  }
  if (std::string nearest = keys::nearest(word, candidates); !nearest.empty()) return nearest;
  const auto begins = std::find_if(candidates.begin(), candidates.end(),
                                   [&](const std::string& name) { return word.size() > 2 && name.starts_with(word); });
  return begins != candidates.end() ? *begins : "";
}

}  // namespace

std::string resolved_field(const std::vector<ResultRow>& rows, const std::string& word) {
  const std::vector<std::string> names = field_names(rows);
  if (const auto field = field_named(names, word)) return *field;
  throw Failure(ExitCode::kBadInput,
                fmt::format("no row has a field '{}'{}", word, keys::did_you_mean(nearest_field(word, names))));
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
  if (row.contains("directory")) result.fields["directory"] = text_of(row, "directory");
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

void add_from_scenes(std::vector<ResultRow>& rows, std::span<const std::string> names,
                     const std::map<std::string, std::filesystem::path>& directories) {
  for (ResultRow& row : rows) {
    std::vector<const scene::Field*> wanted;
    for (const std::string& name : names) {
      if (!row.fields.contains(name) && scene::field_index(name) >= 0) wanted.push_back(&scene::field_at(name));
    }
    const auto directory = directories.find(row.fields.value("job", ""));
    if (wanted.empty() || directory == directories.end()) continue;
    const auto text = read_file(run::RunDirectory{directory->second}.scene());
    if (!text) continue;
    const auto plan = scene::load_scene(*text, "scene.json");
    if (!plan) continue;
    for (const scene::Field* field : wanted) {
      const Json value = to_json(*field, scene::fields().value(*plan, *field));
      if (value.is_primitive() && !value.is_null()) row.scene[field->path] = row.fields[field->path] = value;
    }
  }
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

namespace {

/// Whether a run is done, or was before it went on for longer.
bool has_results(const ResultRow& row) {
  return row.state == "done" || field_text(row, "exit.state") == "done" || row.fields.contains("exit.done_before_s");
}

}  // namespace

std::vector<ResultRow> aggregated(const std::vector<ResultRow>& rows) {
  // Groups in the order in which they are first met.
  std::vector<std::vector<const ResultRow*>> groups;
  std::map<std::pair<std::string, RowVersion>, std::size_t> group_of;
  // What different versions computed is never averaged, nor what a version computed that is not known; a run that is
  // not done yet belongs to the newest.
  std::map<std::string, RowVersion> newest_version;
  for (const ResultRow& row : rows) {
    RowVersion& newest = newest_version[row.parameters.dump()];
    newest = std::max(newest, version_of(row));
  }
  for (const ResultRow& row : rows) {
    const std::string parameters = row.parameters.dump();
    const RowVersion version = version_of(row);
    const bool is_final = version.is_known() || row.state == "done";
    const auto key = std::pair(parameters, is_final ? version : newest_version[parameters]);
    const auto [place, is_new] = group_of.try_emplace(key, groups.size());
    if (is_new) groups.emplace_back();
    auto& group = groups[place->second];
    const std::string id = row.fields.value("job", "");
    const auto is_known = [&](const ResultRow* other) { return !id.empty() && other->fields.value("job", "") == id; };
    if (std::none_of(group.begin(), group.end(), is_known)) group.push_back(&row);
  }

  std::vector<ResultRow> points;
  for (const auto& group : groups) {
    ResultRow point;
    point.parameters = group.front()->parameters;
    for (const auto& [path, value] : point.parameters.items()) point.fields[path] = value;
    point.fields["n_replicas"] = group.size();
    std::vector<ResultRow> done;
    for (const ResultRow* row : group) {
      if (has_results(*row)) done.push_back(*row);
    }
    point.fields["n_done"] = done.size();
    for (const char* version : {kProgram, kPhysics}) {
      if (!done.empty() && done.front().fields.contains(version)) point.fields[version] = done.front().fields[version];
    }
    const bool all_done = std::all_of(group.begin(), group.end(), [](const auto* row) { return row->state == "done"; });
    point.state = all_done ? "done" : "partial";
    point.fields["state"] = point.state;
    take_common_keys(done, point);
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
  if (value->is_null()) return {};
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
