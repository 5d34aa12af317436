// SPDX-License-Identifier: MIT
// The conditions of `shaken results --where`: which rows are kept.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "client/results.h"

namespace shaken::client {

/// Something wrong with an expression, and the byte at which.
struct WhereProblem {
  std::size_t at = 0;
  std::string message;
};

/// A condition on a row, of comparisons FIELD OP VALUE with OP one of = == != < <= > >=, joined by `and`, `or`, `not`
/// and parentheses; `not` binds most, `or` least:
///
///   rods.length<=4.5mm and (order.mean>0.5 or not state=done)
///
/// FIELD is the name of a field (ResultRow) or the path of any key of a scene. VALUE is a number, of a key with its
/// unit where that is not the default one, or a word; what holds spaces or signs stands in quotes. Two numbers are
/// compared as numbers, texts and booleans for equality only. A comparison is false for a row without the field.
class Where {
 public:
  /// Fails with everything that is wrong with the form of `text`, in its order.
  static Result<Where, std::vector<WhereProblem>> parse(std::string_view text);

  /// Every field that is compared, as written, each once.
  std::vector<std::string> names() const;

  /// Looks the names up in `rows` (resolved_field), and values in the units of their fields. Returns everything that is
  /// wrong: a name that no row has, a value that cannot be compared with it. Keys of a scene are never wrong; neither
  /// is any other name unless `all_known`, that is if the rows have all names that there can be.
  std::vector<WhereProblem> bind(const std::vector<ResultRow>& rows, bool all_known = true);

  /// After bind without problems.
  bool matches(const ResultRow& row) const { return holds(root_, row); }

  /// The fields that some of `rows` lack, and how many do; after bind.
  struct Lack {
    std::string field;
    std::size_t n_rows = 0;
  };
  std::vector<Lack> lacking(const std::vector<ResultRow>& rows) const;

 private:
  friend class WhereParser;

  struct Comparison {
    std::string name;  ///< as written, after bind the field
    std::string op;
    std::string value;  ///< without quotes
    bool quoted = false;
    std::size_t name_at = 0, op_at = 0, value_at = 0;
    bool is_number = false;
    double number = 0;  ///< in the field's own unit
  };
  enum class Kind { kComparison, kNot, kAnd, kOr };
  struct Node {
    Kind kind = Kind::kComparison;
    std::size_t comparison = 0;
    std::vector<std::size_t> parts = {};  ///< nodes
  };

  bool holds(std::size_t node, const ResultRow& row) const;

  std::vector<Comparison> comparisons_;
  std::vector<Node> nodes_;
  std::size_t root_ = 0;
};

/// All of the --where of a command line, of which every one must hold.
class Conditions {
 public:
  /// Throws Failure (kBadInput) with everything that is wrong with the form of all of them.
  static Conditions parse(const std::vector<std::string>& texts);

  /// Puts what is compared into the fields of the rows of runs of `target`, where their scenes have it; before they are
  /// aggregated.
  void add_from_scenes(std::vector<ResultRow>& rows, const Target& target);

  /// Keeps the rows that match. Throws Failure (kBadInput) for names and values that are wrong; tells `err` which
  /// fields some rows lack, with `what` the rows are: "runs".
  void keep_matching(std::vector<ResultRow>& rows, const char* what, std::ostream& err);

 private:
  std::vector<std::string> texts_;
  std::vector<Where> conditions_;
  bool all_known_ = true;  ///< without any summary nobody knows which numbers there will be
};

/// `text`, and below it each problem with a caret at its place.
std::string marked(std::string_view text, const std::vector<WhereProblem>& problems);

}  // namespace shaken::client
