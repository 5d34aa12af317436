// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "base/steadiness.h"
#include "client/live/api_client.h"
#include "client/live/json.h"
#include "client/live/target.h"
#include "client/replicas.h"

namespace shaken::client {

/// One line of the results: named values, flat. Swept parameters go by their path ("rods.area_fraction"), the members
/// of summary.json by theirs ("order.mean"), besides "job", "sweep", "state", "label" and "replica".
struct ResultRow {
  Json source;                       ///< as the daemon sent it; null for an aggregated row
  Json parameters = Json::object();  ///< {path: value}
  Json scene = Json::object();       ///< other keys of its scene, as far as they were asked for: {path: value}
  std::string state;
  Json fields = Json::object();  ///< everything by name, parameters included; numbers, texts and booleans only

  /// The value as a number: a number, or one at the beginning of a text ("4.5 mm"). NaN if there is none.
  double number(const std::string& field) const;
};

/// From one element of "rows" of GET /v1/results.
ResultRow result_row(const Json& row);
/// The daemon's results of a sweep, or of one job.
std::vector<ResultRow> result_rows(ApiClient& session, const Target& target);

/// Puts what the rows' own scenes say of `names` into their fields, where a row lacks it and `name` is a key of a
/// scene: a row has the swept ones only. `directories` are those of the runs, by job; a run that has not begun has no
/// scene.
void add_from_scenes(std::vector<ResultRow>& rows, std::span<const std::string> names,
                     const std::map<std::string, std::filesystem::path>& directories);

/// What computed a row: program and physics, which both can change its numbers. Empty texts: it is not done yet.
struct RowVersion {
  std::string program;  ///< "0.1.0"
  std::string physics;  ///< "3"
  /// "shaken 0.1.0, physics 3"
  std::string text() const;
  bool is_known() const { return !program.empty() || !physics.empty(); }
  friend bool operator<(const RowVersion& a, const RowVersion& b) {
    return std::tie(a.program, a.physics) < std::tie(b.program, b.physics);
  }
};
RowVersion version_of(const ResultRow& row);
/// From the member "versions" of a summary.json.
RowVersion version_of(const Json& versions);
/// Whether different versions computed these rows.
bool has_several_versions(const std::vector<ResultRow>& rows);

/// One row per point and version: replicas of equal parameters together, each run once, however many points of a sweep
/// ask for it. Fields: the parameters, "state" ("done" if all are, otherwise "partial"), "versions.shaken",
/// "versions.physics", "n_replicas", "n_done", and of done replicas: for each number F its mean as F and the standard
/// error of that (replica_mean) as error_field(F), in place of the runs' own; "F:n" where only so many of them have a
/// value; for "n_effective" the sum; for "steady" true if all are, false if one is not.
std::vector<ResultRow> aggregated(const std::vector<ResultRow>& rows);

/// The field of the standard error of `field`, in rows of single runs and in aggregated ones: own_error_field(), or
/// "F:sem" where a run has no error of its own.
std::string error_field(const std::string& field);

/// The field that holds a run's own standard error of `field`: "order.sem" of "order.mean", "measured.X.sem" of
/// "measured.X.value"; empty if there is none.
std::string own_error_field(const std::string& field);

/// Standard error of `field` in a row, aggregated or not; NaN where it is not known.
double standard_error(const ResultRow& row, const std::string& field);

/// Of what kind of time the average `field` is: its own "steady" tells, or the run's where its own is null. kSteady if
/// the field is no average over time.
Steadiness steadiness(const ResultRow& row, const std::string& field);

/// The field that `word` means: itself, "measured.WORD.value", "order.mean" where it is "S", or the error of such a
/// field where `word` is "WORD.sem" or "WORD:sem". A field that is null in every row is there all the same. Throws
/// Failure (kBadInput), with the nearest name, if no row has it.
std::string resolved_field(const std::vector<ResultRow>& rows, const std::string& word);

/// The same among `names`; none if it is not there.
std::optional<std::string> field_named(std::span<const std::string> names, const std::string& word);

/// The fields of all rows, in the order met.
std::vector<std::string> field_names(const std::vector<ResultRow>& rows);
/// Parameters that differ between rows, in the order met.
std::vector<std::string> swept_parameters(const std::vector<ResultRow>& rows);

/// A field's value as text; empty if the row does not have it.
std::string field_text(const ResultRow& row, const std::string& field);
/// The rows with a line of names: the given fields, in their order; all fields of all rows if none are given.
std::string to_csv(const std::vector<ResultRow>& rows, std::vector<std::string> fields = {});

}  // namespace shaken::client
