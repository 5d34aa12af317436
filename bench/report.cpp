// SPDX-License-Identifier: MIT
#include "bench/report.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "base/failure.h"
#include "base/files.h"
#include "base/processor.h"
#include "base/table.h"
#include "base/text.h"
#include "run/files/version.h"

namespace shaken::bench {
namespace {

int n_cores() { return static_cast<int>(std::thread::hardware_concurrency()); }

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
  std::string text;
  for (const Json& row : rows) {
    std::vector<std::pair<std::string, std::string>> cells;
    flatten(row, "", cells);
    std::string titles, line;
    for (const auto& [name, value] : cells) {
      titles += (titles.empty() ? "" : ",") + name;
      line += (&name == &cells.front().first ? "" : ",") + value;
    }
    if (text.empty()) text = titles + "\n";
    text += line + "\n";
  }
  return text;
}

std::string plot_data(const Json& rows, const std::vector<Column>& columns) {
  std::string text = "#";
  for (const Column& column : columns) text += " " + column.title + (column.error.empty() ? "" : ", error");
  for (const Json& row : rows) {
    std::string line;
    for (const Column& column : columns) {
      const Json& value = member_of(row, column.member);
      line += line.empty() ? "\n" : " ";
      line += value.is_string() ? "\"" + value.get<std::string>() + "\""
                                : fmt::format("{:.6g}", column.scale * number_of(row, column.member));
      if (!column.error.empty()) line += fmt::format(" {:.4g}", column.scale * number_of(row, column.error));
    }
    text += line;
  }
  return text + "\n";
}

Curve curve(const Json& rows, const Column& x, const Column& y) {
  Curve curve;
  curve.label = y.title;
  for (const Json& row : rows) {
    curve.x.push_back(x.scale * number_of(row, x.member));
    curve.y.push_back(y.scale * number_of(row, y.member));
    if (!y.error.empty()) curve.y_error.push_back(y.scale * number_of(row, y.error));
  }
  return curve;
}

void draw_bars(const std::filesystem::path& folder, const std::string& name, const Json& rows, const Column& label,
               const std::vector<Bars>& panels) {
  const auto n_panels = static_cast<int>(panels.size());
  const int width = std::max(700, 200 + 45 * static_cast<int>(rows.size()));
  std::string script = plot_head(name, {n_panels * width, 750}) + plot_axes("y") +
                       fmt::format(R"(set style data histograms
set style fill solid 1 border rgb '#ffffff'
set xtics scale 0 rotate by 35 right noenhanced font ',13'
set errorbars 0.5 front linecolor '#333333'
set bmargin 8
set rmargin 2
set key above horizontal samplen 1 spacing 1.1 font ',14'
set xrange [-0.6:{}]
set multiplot layout 1,{}
)",
                                   static_cast<double>(rows.size()) - 0.4, n_panels);
  std::vector<Column> columns{label};
  std::size_t place = 2;  // column of the data
  for (const Bars& of : panels) {
    const std::size_t n = of.heights.size();
    const bool has_errors = !of.heights.front().error.empty();
    script += "set title " + gnuplot_literal(of.title) + "\nset style histogram ";
    script += of.stacked   ? "rowstacked\nset boxwidth 0.7\n"
              : has_errors ? "errorbars gap 1 linewidth 1\nset boxwidth 0.9\n"
                           : "clustered gap 1\nset boxwidth 0.9\n";
    for (const std::string& command : of.commands) script += command + "\n";
    for (std::size_t k = 0; k < n; ++k) {
      script += fmt::format("{} '{}.dat' using {}{}:xtic(1) title {} linecolor '{}'", k == 0 ? "plot" : ",", name,
                            place, has_errors ? fmt::format(":{}", place + 1) : "",
                            gnuplot_literal(of.heights[k].title), curve_colour(k, n));
      if (!of.stacked && !has_errors) {
        script += fmt::format(
            ", '' using ($0+{:.3f}):{}:(sprintf('%.3g', ${})) with labels font ',12' offset 0,0.6 notitle",
            (static_cast<double>(k) - (static_cast<double>(n) - 1) / 2) / (static_cast<double>(n) + 1), place, place);
      }
      place += has_errors ? 2 : 1;
    }
    script += "\nunset logscale y\n";
    columns.insert(columns.end(), of.heights.begin(), of.heights.end());
  }
  draw_plot(folder, name, plot_data(rows, columns), script + "unset multiplot\n");
}

std::string this_machine() {
  return fmt::format("{}, {} cores; {}; {}", cpu_name(), n_cores(), run::compiler(), SHAKEN_BENCH_FLAGS);
}

Report::Report(std::string file_name, const std::string& bench)
    : name(std::move(file_name)),
      json{{"bench", bench},
           {"version", run::version()},
           {"machine",
            {{"cpu", cpu_name()}, {"cores", n_cores()}, {"compiler", run::compiler()}, {"flags", SHAKEN_BENCH_FLAGS}}},
           {"rows", Json::array()}},
      text(fmt::format("shaken {} on {}\n", run::version(), this_machine())) {}

void Report::add(const Json& more, const char* member) {
  json.at(member).insert(json.at(member).end(), more.begin(), more.end());
}

void Output::declare(CLI::App& app, const char* files) {
  app.add_option("-o,--out", folder, fmt::format("Also write {} there", files))->type_name("DIR");
  app.add_flag("--json", json, "Print JSON");
}

void Output::give(const Report& report, const std::function<void(const std::filesystem::path&)>& draw) const {
  const std::string text = report.json.dump(2) + "\n";
  fmt::print("{}", json ? text : report.text);
  std::fflush(stdout);
  if (folder.empty()) return;
  done_or_fail(make_folder(folder));
  done_or_fail(write_file_atomically(std::filesystem::path(folder) / (report.name + ".json"), text));
  done_or_fail(write_file_atomically(std::filesystem::path(folder) / (report.name + ".csv"), csv(report.rows())));
  if (draw) draw(folder);
}

}  // namespace shaken::bench
