// SPDX-License-Identifier: MIT
#include "client/where.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <ostream>
#include <utility>

#include "base/failure.h"
#include "base/keys/nearest.h"
#include "base/keys/units.h"
#include "base/text.h"
#include "client/live/target.h"
#include "scene/fields.h"

namespace shaken::client {
namespace {

/// Parentheses and `not` within each other; more are no condition that a person writes, and would cost stack.
constexpr int kMaxDepth = 100;

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::string_view kSigns = "<>=!";
/// Where a word ends.
constexpr std::string_view kEndOfWord = " \t\r\n<>=!()\"'";
constexpr std::string_view kComparisons[] = {"=", "==", "!=", "<", "<=", ">", ">="};

struct Token {
  enum class Kind { kWord, kQuoted, kSign, kOpen, kClose, kEnd };
  Kind kind = Kind::kEnd;
  std::string text;
  std::size_t at = 0;

  bool is_word(std::string_view word) const { return kind == Kind::kWord && text == word; }
  bool is_joint() const { return is_word("and") || is_word("or") || is_word("not"); }
};

/// The last token is of the kind kEnd.
std::vector<Token> tokens_of(std::string_view text, std::vector<WhereProblem>& problems) {
  std::vector<Token> tokens;
  const auto add = [&](Token::Kind kind, std::size_t at, std::string_view part) {
    tokens.push_back({kind, std::string(part), at});
  };
  for (std::size_t at = 0; (at = text.find_first_not_of(kSpace, at)) != std::string_view::npos;) {
    const char first = text[at];
    std::size_t end = at + 1;
    if (first == '(' || first == ')') {
      add(first == '(' ? Token::Kind::kOpen : Token::Kind::kClose, at, text.substr(at, 1));
    } else if (first == '"' || first == '\'') {
      const std::size_t close = text.find(first, at + 1);
      if (close == std::string_view::npos) problems.push_back({at, "this quote is never closed"});
      add(Token::Kind::kQuoted, at, text.substr(at + 1, std::min(close, text.size()) - at - 1));
      end = close == std::string_view::npos ? text.size() : close + 1;
    } else if (kSigns.find(first) != std::string_view::npos) {
      end = std::min(text.find_first_not_of(kSigns, at), text.size());
      add(Token::Kind::kSign, at, text.substr(at, end - at));
    } else {
      end = std::min(text.find_first_of(kEndOfWord, at), text.size());
      add(Token::Kind::kWord, at, text.substr(at, end - at));
    }
    at = end;
  }
  add(Token::Kind::kEnd, text.size(), "");
  return tokens;
}

bool is_unit(std::string_view word) {
  const auto units = scene::units();
  return std::any_of(units.begin(), units.end(), [&](const keys::Unit& unit) { return unit.name == word; });
}

bool is_number_word(std::string_view word) {
  const auto written = keys::split_quantity(word);
  return written && written->unit.empty();
}

std::string shown(const Token& token) {
  return token.kind == Token::Kind::kEnd ? "the end" : fmt::format("'{}'", printable(token.text));
}

}  // namespace

/// Recursive descent:
///   any        = all {"or" all}
///   all        = one {"and" one}
///   one        = "not" one | "(" any ")" | comparison
///   comparison = name sign value [unit]
/// Where a comparison cannot be read, it goes on behind it.
class WhereParser {
 public:
  explicit WhereParser(std::string_view text) : tokens_(tokens_of(text, problems_)) {}

  Result<Where, std::vector<WhereProblem>> parse() {
    where_.root_ = whole();
    while (next().kind == Token::Kind::kClose) {
      problem(take().at, "this ) closes nothing");
      skip();
      if (next().is_word("and") || next().is_word("or")) {
        take();
        (void)whole();
      }
    }
    if (problems_.empty()) return std::move(where_);
    std::stable_sort(problems_.begin(), problems_.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
    return problems_;
  }

 private:
  using Kind = Where::Kind;

  const Token& next() const { return tokens_[place_]; }
  Token take() {
    const Token& token = tokens_[place_];
    if (token.kind != Token::Kind::kEnd) ++place_;
    return token;
  }
  void problem(std::size_t at, std::string message) { problems_.push_back({at, std::move(message)}); }
  std::size_t node(Where::Node made) {
    where_.nodes_.push_back(std::move(made));
    return where_.nodes_.size() - 1;
  }
  /// To where the next comparison may be joined.
  void skip() {
    while (!next().is_word("and") && !next().is_word("or") && next().kind != Token::Kind::kClose &&
           next().kind != Token::Kind::kEnd) {
      take();
    }
  }
  static std::string hint(const Token& token) {
    if (token.text == "&&" || token.text == "&") return "; did you mean and?";
    if (token.text == "||" || token.text == "|") return "; did you mean or?";
    static const std::vector<std::string> kJoints{"and", "or"};
    return token.kind == Token::Kind::kWord ? keys::did_you_mean(keys::nearest(token.text, kJoints)) : "";
  }

  /// Up to a ) or the end.
  std::size_t whole() {
    const std::size_t first = any();
    while (next().kind != Token::Kind::kClose && next().kind != Token::Kind::kEnd) {
      const Token left = take();
      problem(left.at, fmt::format("{} follows a whole comparison: join them by and, or{}", shown(left), hint(left)));
      skip();
      while (next().is_word("and") || next().is_word("or")) {
        take();
        (void)any();
      }
    }
    return first;
  }
  std::size_t any() {
    return joined(Kind::kOr, "or", [this] { return all(); });
  }
  std::size_t all() {
    return joined(Kind::kAnd, "and", [this] { return one(); });
  }

  template <class Part>
  std::size_t joined(Kind kind, std::string_view word, Part part) {
    std::vector<std::size_t> parts{part()};
    while (next().is_word(word)) {
      take();
      parts.push_back(part());
    }
    return parts.size() == 1 ? parts.front() : node({kind, 0, std::move(parts)});
  }

  std::size_t one() {
    const bool is_not = next().is_word("not");
    if (!is_not && next().kind != Token::Kind::kOpen) return comparison();
    if (depth_ == kMaxDepth) {
      problem(next().at, fmt::format("more than {} parentheses and nots within each other", kMaxDepth));
      too_deep_ = true;
      place_ = tokens_.size() - 1;  // what closes them would only be told again
      return node({});
    }
    ++depth_;
    const std::size_t open_at = take().at;
    std::size_t inner = 0;
    if (is_not) {
      inner = node({Kind::kNot, 0, {one()}});
    } else {
      inner = whole();
      if (next().kind == Token::Kind::kClose) {
        take();
      } else if (!too_deep_) {
        problem(open_at, "this ( is never closed");
      }
    }
    --depth_;
    return inner;
  }

  std::size_t comparison() {
    Where::Comparison made;
    const Token name = next();
    if ((name.kind != Token::Kind::kWord && name.kind != Token::Kind::kQuoted) || name.is_joint()) {
      problem(name.at, fmt::format("a comparison is missing before {}: FIELD OP VALUE, for example order.mean>0.5",
                                   shown(name)));
      if (name.kind == Token::Kind::kSign) take();
      if (!name.is_joint()) skip();
      return node({});
    }
    take();
    made.name = name.text;
    made.name_at = name.at;

    const Token sign = next();
    if (sign.kind != Token::Kind::kSign) {
      problem(sign.at, fmt::format("a comparison is missing behind '{0}': {0}>0.5, or {0}=true", printable(name.text)));
      skip();
      return node({});
    }
    take();
    if (std::find(std::begin(kComparisons), std::end(kComparisons), sign.text) == std::end(kComparisons)) {
      problem(sign.at, fmt::format("'{}' compares nothing; one of = != < <= > >= does", sign.text));
    }
    made.op = sign.text == "==" ? "=" : sign.text;
    made.op_at = sign.at;

    const Token value = next();
    if ((value.kind != Token::Kind::kWord && value.kind != Token::Kind::kQuoted) || value.is_joint()) {
      problem(value.at, fmt::format("a value is missing before {}", shown(value)));
      if (value.kind == Token::Kind::kSign || value.kind == Token::Kind::kOpen) skip();
      return node({});
    }
    take();
    made.value = value.text;
    made.value_at = value.at;
    made.quoted = value.kind == Token::Kind::kQuoted;
    if (!made.quoted && next().kind == Token::Kind::kWord && is_number_word(made.value) && is_unit(next().text)) {
      made.value += " " + take().text;
    }
    where_.comparisons_.push_back(std::move(made));
    return node({Kind::kComparison, where_.comparisons_.size() - 1, {}});
  }

  std::vector<WhereProblem> problems_;
  std::vector<Token> tokens_;
  std::size_t place_ = 0;
  int depth_ = 0;
  bool too_deep_ = false;
  Where where_;
};

Result<Where, std::vector<WhereProblem>> Where::parse(std::string_view text) { return WhereParser(text).parse(); }

std::vector<std::string> Where::names() const {
  std::vector<std::string> names;
  for (const Comparison& comparison : comparisons_) {
    if (std::find(names.begin(), names.end(), comparison.name) == names.end()) names.push_back(comparison.name);
  }
  return names;
}

std::vector<WhereProblem> Where::bind(const std::vector<ResultRow>& rows, bool all_known) {
  std::vector<WhereProblem> problems;
  const std::vector<std::string> fields = field_names(rows);
  for (Comparison& comparison : comparisons_) {
    const int key = scene::field_index(comparison.name);
    const keys::Dimension dimension = key < 0 ? keys::Dimension::kPlain : scene::field_at(comparison.name).dimension;
    const auto number = keys::parse_quantity(comparison.value, dimension);
    comparison.is_number = !comparison.quoted && number;
    if (comparison.is_number) comparison.number = *number;

    if (const auto field = field_named(fields, comparison.name)) {
      comparison.name = *field;
    } else if (key < 0 && all_known && !rows.empty()) {
      std::vector<std::string> names = fields;
      for (const scene::Field& each : scene::fields()) names.push_back(each.path);
      problems.push_back({comparison.name_at, fmt::format("no row has a field '{}'{}", printable(comparison.name),
                                                          keys::did_you_mean(keys::nearest(comparison.name, names)))});
      continue;
    }

    bool any_number = false, any_text = false, any_boolean = false;
    for (const ResultRow& row : rows) {
      const auto value = row.fields.find(comparison.name);
      if (value == row.fields.end()) continue;
      any_number |= value->is_number();
      any_text |= value->is_string();
      any_boolean |= value->is_boolean();
    }
    if (!any_number && !any_text && !any_boolean) continue;
    const bool is_equality = comparison.op == "=" || comparison.op == "!=";
    const bool is_truth = comparison.value == "true" || comparison.value == "false";
    if (!is_equality && !any_number) {
      problems.push_back(
          {comparison.op_at, fmt::format("{} is {}: only = and != compare it", printable(comparison.name),
                                         any_text ? "a text" : "true or false")});
    } else if (any_number && !comparison.is_number && !(is_equality && any_text)) {
      problems.push_back(
          {comparison.value_at, number || comparison.quoted
                                    ? fmt::format("{} is a number: without quotes", printable(comparison.name))
                                    : printable(number.error().message)});
    } else if (any_boolean && !any_number && !any_text && !is_truth) {
      problems.push_back({comparison.value_at, fmt::format("{} is true or false", printable(comparison.name))});
    }
  }
  return problems;
}

bool Where::holds(std::size_t index, const ResultRow& row) const {
  const Node& node = nodes_[index];
  const auto part_holds = [&](std::size_t part) { return holds(part, row); };
  switch (node.kind) {
    case Kind::kNot:
      return !holds(node.parts.front(), row);
    case Kind::kAnd:
      return std::all_of(node.parts.begin(), node.parts.end(), part_holds);
    case Kind::kOr:
      return std::any_of(node.parts.begin(), node.parts.end(), part_holds);
    case Kind::kComparison:
      break;
  }
  const Comparison& comparison = comparisons_[node.comparison];
  const auto found = row.fields.find(comparison.name);
  if (found == row.fields.end()) return false;
  const std::string& op = comparison.op;
  if (found->is_number() && comparison.is_number) {
    const auto left = found->get<double>(), right = comparison.number;
    if (op == "=") return left == right;
    if (op == "!=") return left != right;
    if (op == "<") return left < right;
    if (op == "<=") return left <= right;
    if (op == ">") return left > right;
    return left >= right;
  }
  if (op != "=" && op != "!=") return false;
  const bool equal = !found->is_number() &&
                     (found->is_string() ? found->get_ref<const std::string&>() : found->dump()) == comparison.value;
  return equal == (op == "=");
}

std::vector<Where::Lack> Where::lacking(const std::vector<ResultRow>& rows) const {
  std::vector<Lack> lacks;
  for (const std::string& name : names()) {
    const auto n = std::count_if(rows.begin(), rows.end(), [&](const auto& row) { return !row.fields.contains(name); });
    if (n > 0) lacks.push_back({name, static_cast<std::size_t>(n)});
  }
  return lacks;
}

Conditions Conditions::parse(const std::vector<std::string>& texts) {
  Conditions all;
  all.texts_ = texts;
  std::string problems;
  for (const std::string& text : texts) {
    auto condition = Where::parse(text);
    if (condition) {
      all.conditions_.push_back(std::move(condition).value());
    } else {
      problems += "\n" + marked(text, condition.error());
    }
  }
  if (!problems.empty()) throw Failure(ExitCode::kBadInput, "--where:" + problems);
  return all;
}

void Conditions::add_from_scenes(std::vector<ResultRow>& rows, const Target& target) {
  std::vector<std::string> names;
  for (const Where& condition : conditions_) {
    for (std::string& name : condition.names()) names.push_back(std::move(name));
  }
  std::map<std::string, std::filesystem::path> directories;
  for (const Json& job : jobs_of(target)) directories[job.at("id")] = job.value("directory", "");
  client::add_from_scenes(rows, names, directories);
  all_known_ = std::any_of(rows.begin(), rows.end(), [](const ResultRow& row) {
    const auto summary = row.source.find("summary");
    return summary != row.source.end() && summary->is_object();
  });
}

void Conditions::keep_matching(std::vector<ResultRow>& rows, const char* what, std::ostream& err) {
  std::string problems;
  for (std::size_t k = 0; k < conditions_.size(); ++k) {
    const auto wrong = conditions_[k].bind(rows, all_known_);
    if (!wrong.empty()) problems += "\n" + marked(texts_[k], wrong);
  }
  if (!problems.empty()) {
    throw Failure(ExitCode::kBadInput, "--where:" + problems + "\n`shaken results --csv` shows all names");
  }
  std::map<std::string, std::size_t> lacks;
  for (const Where& condition : conditions_) {
    for (const auto& [field, n] : condition.lacking(rows)) lacks[field] = n;
  }
  for (const auto& [field, n] : lacks) {
    err << fmt::format("{} of {} {} lack {}: comparisons with it are false for them\n", n, rows.size(), what,
                       printable(field));
  }
  std::erase_if(rows, [&](const ResultRow& row) {
    return !std::all_of(conditions_.begin(), conditions_.end(), [&](const Where& each) { return each.matches(row); });
  });
}

std::string marked(std::string_view text, const std::vector<WhereProblem>& problems) {
  std::string lines = "  " + printable(text);
  for (const WhereProblem& problem : problems) {
    const std::size_t column = display_width(printable(text.substr(0, problem.at)));
    lines += fmt::format("\n  {}^ {}", std::string(column, ' '), problem.message);
  }
  return lines;
}

}  // namespace shaken::client
