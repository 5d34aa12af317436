#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace shaken::bench {

using Json = nlohmann::ordered_json;

/// Where a number of each row is, and how people read it.
struct Column {
  std::string title;
  std::string member;         ///< path within the row: "scheduled/spread"
  std::string format = "{}";  ///< of the number, and of its error as a second argument
  double scale = 1;           ///< of both
  std::string error = {};     ///< path of the error; empty if there is none
};

/// What is at `path` in a row; null if nothing is.
const Json& member_of(const Json& row, std::string_view path);

/// Such a text: "variant".
std::string text_of(const Json& row, const char* member);

/// An array of rows as a table for people, texts flush left and numbers flush right. Nothing and NaN are "-", true
/// "yes" and false "NO".
std::string table(const Json& rows, const std::vector<Column>& columns);
/// All of an array of rows; what is nested is named with dots, and what a row does not have is left empty.
std::string csv(const Json& rows);

/// What a bench found out: the rows, and the same for people.
struct Report {
  std::string name;  ///< of its files
  Json json;         ///< "bench", "version", "machine", what else holds for all rows, and "rows"
  std::string text;
  bool has_verdict = false;  ///< Python says in words what the rows come to

  Report(std::string file_name, const std::string& bench);
  const Json& rows() const { return json.at("rows"); }
  /// Adds rows to those of `member`.
  void add(const Json& more, const char* member = "rows");
};

/// "AMD EPYC, 2 cores; GNU 12.2.0, Release; -O3 -DNDEBUG": what speed depends on besides the code.
std::string this_machine();

/// Where a report goes.
struct Output {
  bool json = false;     ///< to stdout as JSON, not as text
  std::string folder{};  ///< NAME.json, NAME.csv and pictures too; empty: nowhere

  /// Adds --json and --out, which writes `files`.
  void declare(CLI::App& app, const char* files = "CSV, JSON and PNG");
  /// Writes the report, and has its verdict told and pictures drawn by Python; where that fails, stderr says why.
  void give(const Report& report) const;
};

}  // namespace shaken::bench
