#include "bench/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "base/failure.h"
#include "base/files.h"
#include "base/plots_by_python.h"
#include "base/processor.h"
#include "base/table.h"
#include "base/text.h"
#include "run/files/version.h"

namespace shaken::bench {
namespace {

double number_of(const Json& row, const std::string& path) {
  const Json& value = path.empty() ? Json() : member_of(row, path);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string cell(const Json& row, const Column& column) {
  const Json& value = member_of(row, column.member);
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "NO";
  if (value.is_string()) return value.get<std::string>();
  if (!std::isfinite(value.get<double>())) return "-";
  return fmt::format(fmt::runtime(column.format), column.scale * value.get<double>(),
                     column.scale * number_of(row, column.error));
}

/// The cells of a row of CSV, and their names.
void flatten(const Json& value, const std::string& name, std::vector<std::pair<std::string, std::string>>& cells) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) flatten(member, name.empty() ? key : name + "." + key, cells);
  } else if (value.is_array()) {
    std::string text;
    for (const Json& element : value) text += (text.empty() ? "" : " ") + element.dump();
    cells.emplace_back(name, text);
  } else {
    cells.emplace_back(name, value.is_string() ? csv_field(value.get<std::string>()) : value.dump());
  }
}

}  // namespace

const Json& member_of(const Json& row, std::string_view path) {
  static const Json nothing;
  const Json::json_pointer pointer("/" + std::string(path));
  return row.contains(pointer) ? row.at(pointer) : nothing;
}

std::string text_of(const Json& row, const char* member) { return row.at(member).get<std::string>(); }

std::string table(const Json& rows, const std::vector<Column>& columns) {
  std::vector<Table::Column> titles;
  for (const Column& column : columns) {
    const bool is_text = !rows.empty() && member_of(rows.front(), column.member).is_string();
    titles.push_back({column.title, is_text ? Table::Align::kLeft : Table::Align::kRight});
  }
  Table table(std::move(titles));
  for (const Json& row : rows) {
    Row cells;
    for (const Column& column : columns) cells.push_back(cell(row, column));
    table.add_row(std::move(cells));
  }
  return table.text(0);
}

std::string csv(const Json& rows) {
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> lines;
  for (const Json& row : rows) {
    std::vector<std::pair<std::string, std::string>> cells;
    flatten(row, "", cells);
    lines.emplace_back(cells.begin(), cells.end());
    for (const auto& [name, cell] : cells) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (std::map<std::string, std::string>& line : lines) {
    for (const std::string& name : names) text += line[name] + (name == names.back() ? "\n" : ",");
  }
  return text;
}

namespace {

/// What this program was compiled with; the wide build's simulator has more (packaging/cmake/Options.cmake).
std::string flags() {
  std::error_code error;
  const bool is_wide = std::filesystem::read_symlink("/proc/self/exe", error).string().ends_with("-wide");
  return is_wide ? SHAKEN_BENCH_FLAGS "; simulator: " SHAKEN_WIDE_FLAGS : SHAKEN_BENCH_FLAGS;
}

}  // namespace

std::string this_machine() {
  return fmt::format("{}, {} cores; {}; {}", cpu_name(), allowed_cores(), run::compiler(), flags());
}

Report::Report(std::string file_name, const std::string& bench)
    : name(std::move(file_name)),
      json{{"bench", bench},
           {"version", run::version()},
           {"machine",
            {{"cpu", cpu_name()}, {"cores", allowed_cores()}, {"compiler", run::compiler()}, {"flags", flags()}}},
           {"rows", Json::array()}},
      text(fmt::format("shaken {} on {}\n", run::version(), this_machine())) {}

void Report::add(const Json& more, const char* member) {
  json.at(member).insert(json.at(member).end(), more.begin(), more.end());
}

void Output::declare(CLI::App& app, const char* files) {
  app.add_option("-o,--out", folder, fmt::format("Also write {} there", files))->type_name("DIR");
  app.add_flag("--json", json, "Print JSON");
}

void Output::give(const Report& report) const {
  // what was measured is kept whatever becomes of the rest
  const auto by_python = [](const char* what, const std::vector<std::string>& arguments, const std::string& input) {
    try {
      return plots_by_python(arguments, input);
    } catch (const Failure& failure) {
      fmt::print(stderr, "shaken-bench: no {}: {}\n", what, failure.what());
      return std::vector<std::string>();
    }
  };
  const std::string text = report.json.dump(2) + "\n";
  fmt::print("{}", json ? text : report.text);
  if (report.has_verdict && !json) {
    const std::vector<std::string> verdict = by_python("verdict", {"verdict", "-"}, text);
    for (const std::string& line : verdict) fmt::print("{}\n", line);
    if (verdict.empty()) fmt::print("{}", csv(report.rows()));
  }
  std::fflush(stdout);
  if (folder.empty()) return;
  done_or_fail(make_folder(folder));
  const std::filesystem::path file = std::filesystem::path(folder) / (report.name + ".json");
  done_or_fail(write_file_atomically(file, text));
  done_or_fail(write_file_atomically(std::filesystem::path(folder) / (report.name + ".csv"), csv(report.rows())));
  by_python("pictures", {"bench", file.string(), "--out", folder}, "");
}

}  // namespace shaken::bench
