#include "run/export/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>

#include "base/text.h"
#include "run/files/unit_of_name.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// "/msd/total_mm2" is in the group "/msd".
std::string group_of(const std::string& path) { return path.substr(0, path.find_last_of('/')); }

/// Where an array stands among the records of its observable, its errors behind it; what has no record comes last.
std::size_t rank_of(const std::string& path) {
  const std::optional<ArrayRecord> record = array_record(path);
  if (!record) return std::numeric_limits<std::size_t>::max();
  return 2 * static_cast<std::size_t>(record->output - record->kind->arrays.data()) + (record->is_error ? 1 : 0);
}

/// Paths of what an array is measured at, the fastest first; none of an axis.
std::vector<std::string> axes_of(const std::string& path) {
  std::vector<std::string> axes;
  if (const std::optional<ArrayRecord> record = array_record(path)) {
    for (const std::string& name : record->kind->axes_of(record->output->name)) axes.push_back(record->block + name);
  }
  std::ranges::reverse(axes);
  return axes;
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
  std::ranges::stable_sort(paths, {}, rank_of);
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

/// Of a group that has nothing but the axes of maps, as `defect_maps` has: those maps, which lie in groups below it.
void add_maps(const Observables& arrays, std::vector<std::string>& paths) {
  const std::set<std::string> axes(paths.begin(), paths.end());
  if (axes.size() < 2) return;
  for (const auto& [path, values] : arrays) {
    const std::vector<std::string> its_axes = axes_of(path);
    if (std::set<std::string>(its_axes.begin(), its_axes.end()) == axes) paths.push_back(path);
  }
  std::ranges::stable_sort(paths, {}, rank_of);
}

/// If all columns are of one observable, and one of them is a map: each axis and each value in a line for each point,
/// also of what depends on the faster axes only.
void spread_axes(const Observables& arrays, std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) {
    if (auto axes = axes_of(column.path); axes.size() > names.size()) names = std::move(axes);
  }
  if (names.size() < 2) return;
  std::vector<Column> axes;
  for (const std::string& name : names) {
    const auto axis = arrays.find(name);
    if (axis == arrays.end() || axis->second.empty()) return;
    axes.push_back({axis->first, axis->second});
  }
  // points of an axis, of which van_hove has some of its own for each lag
  const auto points = [&](std::size_t k) {
    const bool has_rows = axes[k].path.ends_with("/displacement_mm");
    return axes[k].values.size() / (has_rows ? axes[1].values.size() : 1);
  };
  std::vector<std::size_t> sizes{1};  // of what depends on the first 0, 1, 2 ... axes
  for (std::size_t k = 0; k < axes.size(); ++k) sizes.push_back(sizes.back() * points(k));
  const auto is_axis = [&](const Column& column) { return std::ranges::find(names, column.path) != names.end(); };
  std::size_t n_axes = 0;
  for (const Column& column : columns) {
    if (is_axis(column)) continue;
    const std::vector<std::string> own = axes_of(column.path);
    const auto is_shared = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
    if (own.empty() || !std::ranges::all_of(own, is_shared)) return;
    std::size_t depth = axes.size();
    while (depth > 0 && sizes[depth] != column.values.size()) --depth;
    if (depth == 0) return;
    n_axes = std::max(n_axes, depth);
  }
  if (n_axes < 2) return;
  std::vector<Column> table;
  for (std::size_t k = 0; k < n_axes; ++k) {
    Column& axis = table.emplace_back(Column{axes[k].path, std::vector<double>(sizes[n_axes])});
    for (std::size_t row = 0; row < sizes[n_axes]; ++row)
      axis.values[row] = axes[k].values[row / sizes[k] % axes[k].values.size()];
  }
  for (const Column& column : columns) {
    if (is_axis(column)) continue;
    Column& spread = table.emplace_back(Column{column.path, std::vector<double>(sizes[n_axes])});
    for (std::size_t row = 0; row < sizes[n_axes]; ++row)
      spread.values[row] = column.values[row % column.values.size()];
  }
  columns = std::move(table);
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
std::string why_nothing_is_called(std::string_view written, const Observables& arrays) {
  std::string_view name = written;
  while (name.starts_with('/')) name.remove_prefix(1);
  const std::string block(name.substr(0, name.find('/')));
  const bool is_measured = std::ranges::any_of(
      arrays, [&](const auto& array) { return array.first.starts_with(fmt::format("/{}/", block)); });
  if (!is_measured &&
      std::ranges::find(measurement_kinds(), block, &MeasurementKind::name) != measurement_kinds().end()) {
    return fmt::format("'{}' was not measured in this run: its scene has no measure.{}, or its rods no axis",
                       printable(written), block);
  }
  return fmt::format("no array or group of observables is called '{}'", printable(written));
}

}  // namespace

Result<std::string> observables_csv(const Observables& arrays, const std::vector<std::string>& names) {
  std::vector<std::string> paths;
  std::string problems;
  for (const std::string& name : names) {
    std::vector<std::string> found = arrays_of(arrays, name);
    add_maps(arrays, found);
    if (found.empty()) problems += why_nothing_is_called(name, arrays) + "\n";
    for (const std::string& path : found) {
      if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
    }
  }
  if (names.empty()) problems += "no observable is named\n";
  std::vector<Column> columns;
  columns.reserve(paths.size());
  for (const std::string& path : paths) columns.push_back({path, arrays.at(path)});
  spread_axes(arrays, columns);
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
  paths.clear();
  for (const Column& column : columns) paths.push_back(column.path);
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
