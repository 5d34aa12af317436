// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/json.h"

namespace shaken::client {

/// One line of the results: named values, flat. Swept parameters go by their path ("rods.area_fraction"), the members
/// of summary.json by theirs ("order.mean"), besides "job", "sweep", "state", "label" and "replica".
struct ResultRow {
  Json source;                       ///< as the daemon sent it; null for an aggregated row
  Json parameters = Json::object();  ///< {path: value}
  std::string state;
  Json fields = Json::object();  ///< everything by name, parameters included; numbers, texts and booleans only

  /// The value as a number: a number, or one at the beginning of a text ("4.5 mm"). NaN if there is none.
  double number(const std::string& field) const;
};

/// From one element of "rows" of GET /v1/results.
ResultRow result_row(const Json& row);

/// One comparison of --where: FIELD OP VALUE, with OP one of < <= > >= = == !=.
class Condition {
 public:
  /// Throws Failure (kBadInput) if `text` is no comparison.
  explicit Condition(const std::string& text);
  /// A row without the field does not match. Two numbers are compared as such; otherwise only = and != make sense.
  /// Throws Failure (kBadInput) where < or > meets a text.
  bool matches(const ResultRow& row) const;
  const std::string& field() const { return field_; }

 private:
  std::string field_;
  std::string comparison_;
  std::string value_;
};

/// The rows that match all conditions. Throws Failure (kBadInput), with the nearest name, if no row at all has one of
/// the fields.
std::vector<ResultRow> filtered(const std::vector<ResultRow>& rows, std::span<const Condition> conditions);

/// Mean of `values`, and the standard error of that mean: standard deviation (n-1) / sqrt(n); none for n < 2.
struct MeanAndError {
  double mean = 0;
  std::optional<double> sem;
};
/// Needs at least one value.
MeanAndError mean_and_error(std::span<const double> values);

/// One row per point and program version: replicas of equal parameters together. Fields: the parameters,
/// "versions.shaken", "n_replicas", "n_done", and for each number F of the summary its mean over done replicas as F and
/// the standard error between them as "F:sem". Where only one replica is done, "order.mean:sem" is that run's own
/// "order.sem".
std::vector<ResultRow> aggregated(const std::vector<ResultRow>& rows);

/// The fields of all rows, in the order met.
std::vector<std::string> field_names(const std::vector<ResultRow>& rows);
/// Parameters that differ between rows, in the order met.
std::vector<std::string> swept_parameters(const std::vector<ResultRow>& rows);

/// A field's value as text; empty if the row does not have it.
std::string field_text(const ResultRow& row, const std::string& field);
/// All fields of all rows, with a line of names.
std::string to_csv(const std::vector<ResultRow>& rows);

}  // namespace shaken::client
