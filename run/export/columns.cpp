// SPDX-License-Identifier: MIT
#include "run/export/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/text.h"
#include "run/files/unit_of_name.h"

namespace shaken::run {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// What curves are drawn against.
constexpr std::array kAbscissae{"time_s",   "lag_s",     "r_mm",          "q_per_mm",       "theta_rad",
                                "n_z",      "span_s",    "area_fraction", "q_along_per_mm", "q_across_per_mm",
                                "along_mm", "across_mm", "order"};

/// "/msd/total_mm2" is in the group "/msd".
std::string group_of(const std::string& path) { return path.substr(0, path.find_last_of('/')); }
std::string last_word(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

std::size_t rank_of(const std::string& path) {
  const auto found = std::find(kAbscissae.begin(), kAbscissae.end(), last_word(path));
  return static_cast<std::size_t>(found - kAbscissae.begin());
}

/// Paths of the arrays that `name` stands for; none if it names nothing.
std::vector<std::string> arrays_of(const Observables& arrays, std::string_view written) {
  while (written.ends_with('/')) written.remove_suffix(1);
  while (written.starts_with('/')) written.remove_prefix(1);
  const std::string name = fmt::format("/{}", written);
  if (arrays.contains(name)) return {name};
  std::vector<std::string> paths;
  for (const auto& [path, values] : arrays) {
    if (group_of(path) == name) paths.push_back(path);
  }
  std::stable_sort(paths.begin(), paths.end(),
                   [](const std::string& a, const std::string& b) { return rank_of(a) < rank_of(b); });
  return paths;
}

/// Length of the beginning that all paths share, up to and with a slash.
std::size_t shared_folder(const std::vector<std::string>& paths) {
  std::string shared = group_of(paths.front()) + "/";
  for (const std::string& path : paths) {
    while (!path.starts_with(shared)) shared = group_of(group_of(shared)) + "/";
  }
  return shared.size();
}

struct Column {
  std::string path;
  std::vector<double> values;
};

/// A map has two axes and a value for each pair of their points, along the director fastest (docs/files.md): then the
/// axes are repeated so that each value has its place beside it.
void spread_axes(std::vector<Column>& columns) {
  const auto axis = [&](std::string_view name) {
    return std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return last_word(c.path) == name; });
  };
  const auto along = axis("along_mm");
  const auto across = axis("across_mm");
  if (along == columns.end() || across == columns.end() || columns.size() == 2) return;
  const std::size_t n_points = along->values.size() * across->values.size();
  for (auto column = columns.begin(); column != columns.end(); ++column) {
    if (column != along && column != across && column->values.size() != n_points) return;
  }
  const std::vector<double> x = along->values;
  const std::vector<double> y = across->values;
  along->values.resize(n_points);
  across->values.resize(n_points);
  for (std::size_t k = 0; k < n_points; ++k) {
    along->values[k] = x[k % x.size()];
    across->values[k] = y[k / x.size()];
  }
}

std::string number(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string field(const OrderedJson& value) {
  if (value.is_null()) return "";
  if (value.is_number_integer()) return value.dump();
  return value.is_number() ? number(value.get<double>()) : value.dump();
}

std::string summary_row(const std::string& name, const OrderedJson& value, const OrderedJson& estimate) {
  const auto of = [&](const char* key) { return estimate.contains(key) ? field(estimate[key]) : ""; };
  return fmt::format("{},{},{},{},{},{}\n", csv_field(name), field(value), of("sem"), of("n_effective"), of("steady"),
                     of("over_s"));
}

/// A row for each number below `value`.
void append_numbers(const std::string& path, const OrderedJson& value, std::string& rows) {
  if (value.is_object()) {
    for (const auto& [key, below] : value.items()) append_numbers(fmt::format("{}.{}", path, key), below, rows);
  } else if (value.is_number()) {
    rows += summary_row(path, value, {});
  }
}

/// Why `written` names nothing: it was not measured, or there is no such thing.
std::string why_nothing_is_called(std::string_view written, const Observables& arrays,
                                  const std::vector<std::string>& measurable) {
  std::string_view name = written;
  while (name.starts_with('/')) name.remove_prefix(1);
  const std::string block(name.substr(0, name.find('/')));
  const bool is_measured = std::any_of(arrays.begin(), arrays.end(), [&](const auto& array) {
    return array.first.starts_with(fmt::format("/{}/", block));
  });
  if (!is_measured && std::find(measurable.begin(), measurable.end(), block) != measurable.end()) {
    return fmt::format("'{}' was not measured in this run: its scene has no measure.{}, or its rods no axis",
                       printable(written), block);
  }
  return fmt::format("no array or group of observables is called '{}'", printable(written));
}

}  // namespace

Result<std::string> observables_csv(const Observables& arrays, const std::vector<std::string>& names,
                                    const std::vector<std::string>& measurable) {
  std::vector<std::string> paths;
  std::string problems;
  for (const std::string& name : names) {
    const std::vector<std::string> found = arrays_of(arrays, name);
    if (found.empty()) problems += why_nothing_is_called(name, arrays, measurable) + "\n";
    for (const std::string& path : found) {
      if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
    }
  }
  if (names.empty()) problems += "no observable is named\n";
  std::vector<Column> columns;
  columns.reserve(paths.size());
  for (const std::string& path : paths) columns.push_back({path, arrays.at(path)});
  spread_axes(columns);
  const bool have_one_length = std::all_of(columns.begin(), columns.end(), [&](const Column& column) {
    return column.values.size() == columns.front().values.size();
  });
  if (!have_one_length) {
    problems += "arrays of different lengths make no table; name those of one length:\n";
    for (const auto& [path, values] : columns) {
      problems += fmt::format("  {} has {}\n", printable(path.substr(1)), values.size());
    }
  }
  if (!problems.empty()) {
    problems.pop_back();
    return Error{problems};
  }

  std::vector<std::string> fields(columns.size());
  const auto line_of = [&](auto field_of) {
    std::transform(columns.begin(), columns.end(), fields.begin(), field_of);
    return fmt::format("{}\n", fmt::join(fields, ","));
  };
  const std::size_t begin = shared_folder(paths);
  std::string text = line_of([&](const Column& column) { return csv_field(column.path.substr(begin)); });
  for (std::size_t row = 0; row < columns.front().values.size(); ++row) {
    text += line_of([&](const Column& column) { return number(column.values[row]); });
  }
  return text;
}

std::string observables_list(const Observables& arrays) {
  std::map<std::string, std::vector<std::string>> groups;
  for (const auto& [path, values] : arrays) groups[group_of(path)];
  std::string text;
  for (const auto& [group, none] : groups) {
    if (group.empty()) continue;
    text += fmt::format("{}\n", printable(group.substr(1)));
    for (const std::string& path : arrays_of(arrays, group)) {
      const std::string unit = unit_of_name(path);
      text += fmt::format("  {:40} {:>8} values{}\n", printable(path.substr(1)), arrays.at(path).size(),
                          unit == "1" ? "" : " in " + unit);
    }
  }
  return text;
}

Result<std::string> summary_csv(const std::string& summary) {
  const OrderedJson all = OrderedJson::parse(summary, nullptr, false);
  if (!all.is_object()) return Error{"it is no JSON object"};
  std::string rows = "name,value,sem,n_effective,steady,over_s\n";
  for (const auto& [key, value] : all.items()) {
    if (key == "measured" && value.is_object()) {
      for (const auto& [name, estimate] : value.items()) {
        if (estimate.is_object()) rows += summary_row(name, estimate.value("value", OrderedJson()), estimate);
      }
    } else if (key == "order" && value.is_object()) {
      rows += summary_row(key, value.value("mean", OrderedJson()), value);
      for (const char* other : {"std", "tau_s", "t_steady_s"}) {
        if (value.contains(other)) append_numbers(fmt::format("order.{}", other), value[other], rows);
      }
    } else {
      append_numbers(key, value, rows);
    }
  }
  return rows;
}

}  // namespace shaken::run
