// SPDX-License-Identifier: MIT
#include "client/where.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <functional>
#include <memory>

namespace shaken::client {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

ResultRow row_of(const Json& fields) {
  ResultRow row;
  row.fields = fields;
  return row;
}

ResultRow done() {
  return row_of({{"job", "1f0c000000000001"},
                 {"state", "done"},
                 {"label", "rods.length=2.5 replica=1"},
                 {"versions.shaken", "0.1.0"},
                 {"steady", true},
                 {"rods.length", 2.5},
                 {"time.step", 4e-6},
                 {"order.mean", 0.75},
                 {"measured.theta_m_deg.value", 8.5}});
}
ResultRow queued() { return row_of({{"job", "1f0c000000000002"}, {"state", "queued"}, {"rods.length", 4.5}}); }

/// Whether `text` holds for `row`, among rows of which one is done and one is queued.
bool holds(const std::string& text, const ResultRow& row = done()) {
  auto where = Where::parse(text);
  if (!where) {
    ADD_FAILURE() << marked(text, where.error());
    return false;
  }
  const auto problems = where->bind({done(), queued()});
  EXPECT_THAT(problems, IsEmpty()) << marked(text, problems);
  return where->matches(row);
}

std::string problems_of(const std::string& text) {
  auto where = Where::parse(text);
  return marked(text, where ? where->bind({done(), queued()}) : where.error());
}

TEST(Where, AllComparisons) {
  const std::pair<const char*, bool> cases[] = {
      {"rods.length>2", true},         {"rods.length>2.5", false},     {"rods.length>=2.5", true},
      {"rods.length<3", true},         {"rods.length<2.5", false},     {"rods.length<=2.5", true},
      {"rods.length=2.50", true},      {"rods.length==2.4", false},    {"rods.length!=2.4", true},
      {" order.mean  >= 0.5", true},   {"order.mean>-1e3", true},      {"state=done", true},
      {"state!=done", false},          {"state='done'", true},         {"steady=true", true},
      {"steady!=true", false},         {"\"order.mean\">.5", true},    {"label='rods.length=2.5 replica=1'", true},
      {"versions.shaken=0.1.0", true}, {"versions.shaken=0.1", false}, {"job=1f0c000000000001", true},
      {"theta_m_deg>8", true},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(holds(text), expected) << text;
}

TEST(Where, ValuesInTheUnitsOfTheirKeys) {
  const std::pair<const char*, bool> cases[] = {
      {"rods.length=2.5mm", true},  {"rods.length=2.5 mm", true},  {"rods.length=2500um", true},
      {"rods.length<1 cm", true},   {"time.step=4us", true},       {"time.step=4 us", true},
      {"time.step<=0.004ms", true}, {"rods.length=2.5 cm", false},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(holds(text), expected) << text;
}

TEST(Where, NotBindsMostAndOrLeast) {
  const std::pair<const char*, bool> cases[] = {
      {"state=done and rods.length>3", false},
      {"state=done or rods.length>3", true},
      {"state=done or state=queued and rods.length>3", true},
      {"(state=done or state=queued) and rods.length>3", false},
      {"not state=done or rods.length=2.5", true},
      {"not (state=done or rods.length=2.5)", false},
      {"not not state=done", true},
      {"not state=done and state=done", false},
      {"(((state=done)))", true},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(holds(text), expected) << text;
}

TEST(Where, AComparisonIsFalseForARowWithoutTheField) {
  for (const char* text : {"order.mean=0.75", "order.mean!=0.75", "order.mean<2", "order.mean>=-2"}) {
    EXPECT_FALSE(holds(text, queued())) << text;
  }
  EXPECT_TRUE(holds("not order.mean>0.5", queued()));
  auto where = Where::parse("theta_m_deg>1 or order.mean>1 or order.mean<0.5 or rods.length>1");
  ASSERT_TRUE(where);
  ASSERT_THAT(where->bind({done(), queued()}), IsEmpty());
  const auto lacks = where->lacking({done(), queued(), queued()});
  ASSERT_EQ(lacks.size(), 2u);
  EXPECT_EQ(lacks[0].field, "measured.theta_m_deg.value");
  EXPECT_EQ(lacks[1].field, "order.mean");
  EXPECT_EQ(lacks[1].n_rows, 2u);
}

TEST(Where, KeysOfScenesAndUnknownSummariesAreNoMistake) {
  auto where = Where::parse("box.gap>1 or measured.d_mm2_s.value>1");
  ASSERT_TRUE(where);
  EXPECT_EQ(Where(*where).bind({queued()}).size(), 1u);
  EXPECT_THAT(where->bind({queued()}, false), IsEmpty());
  EXPECT_FALSE(where->matches(queued()));
}

TEST(Where, TellsEveryProblemAtItsPlace) {
  EXPECT_EQ(problems_of("order.maen>0.5 and rods.length<4kg or state>done"),
            "  order.maen>0.5 and rods.length<4kg or state>done\n"
            "  ^ no row has a field 'order.maen'; did you mean order.mean?\n"
            "                                 ^ \"kg\" is not a unit of length; use mm, m, cm, um\n"
            "                                             ^ state is a text: only = and != compare it");
  EXPECT_EQ(problems_of("rods.length and order.mean=> 3 or (state=done"),
            "  rods.length and order.mean=> 3 or (state=done\n"
            "              ^ a comparison is missing behind 'rods.length': rods.length>0.5, or rods.length=true\n"
            "                            ^ '=>' compares nothing; one of = != < <= > >= does\n"
            "                                    ^ this ( is never closed");
  // a wide character and one that a terminal would obey: the caret stands below what is printed
  EXPECT_EQ(problems_of("l\u00e4nge='\x1b' or )"),
            "  l\u00e4nge='\\u001b' or )\n"
            "                    ^ a comparison is missing before ')': FIELD OP VALUE, for example order.mean>0.5\n"
            "                    ^ this ) closes nothing");
}

TEST(Where, EveryMistakeIsToldInWords) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "a comparison is missing before the end"},
      {"()", "a comparison is missing before ')'"},
      {"and state=done", "a comparison is missing before 'and'"},
      {"state=done and", "a comparison is missing before the end"},
      {"not", "a comparison is missing before the end"},
      {">3", "a comparison is missing before '>'"},
      {"rods.length>", "a value is missing before the end"},
      {"rods.length> and state=done", "a value is missing before 'and'"},
      {"rods.length>(3)", "a value is missing before '('"},
      {"1<rods.length<3", "'<' follows a whole comparison"},
      {"rods.length ! 3", "'!' compares nothing"},
      {"rods.length<>3", "'<>' compares nothing"},
      {"state=done order.mean>0.5", "'order.mean' follows a whole comparison: join them by and, or"},
      {"state=done && order.mean>0.5", "did you mean and?"},
      {"state=done || order.mean>0.5", "did you mean or?"},
      {"state=done AND order.mean>0.5", "did you mean and?"},
      {"(state=done not steady=true)", "'not' follows a whole comparison"},
      {"state='done", "this quote is never closed"},
      {"state=done)", "this ) closes nothing"},
      {"order.mean=high", "\"high\" is not a number"},
      {"order.mean='0.5'", "order.mean is a number: without quotes"},
      {"order.mean<0.5 mm", "a plain number takes no unit"},
      {"rods.lenght>2", "did you mean rods.length?"},
      {"box.gpa>2", "did you mean box.gap?"},
      {"steady=yes", "steady is true or false"},
      {"steady<true", "only = and != compare it"},
      {"rods.length=2.5s", "\"s\" is a unit of time, not of length"},
  };
  for (const auto& [text, message] : cases) EXPECT_THAT(problems_of(text), HasSubstr(message)) << text;
}

TEST(Where, DepthHasALimitThatIsToldOnce) {
  const auto nested = [](std::size_t n) { return std::string(n, '(') + "state=done" + std::string(n, ')'); };
  EXPECT_TRUE(holds(nested(100)));
  std::string side_by_side = "(state=done)";
  for (int i = 0; i < 200; ++i) side_by_side += " and (state=done)";
  EXPECT_TRUE(holds(side_by_side)) << "none is in another";
  for (const std::string& text : {nested(101), nested(200'000), std::string(200'000, '(')}) {
    const auto where = Where::parse(text);
    ASSERT_FALSE(where);
    ASSERT_EQ(where.error().size(), 1u);
    EXPECT_THAT(where.error()[0].message, HasSubstr("more than 100"));
  }
  std::string chain = "state=done";
  for (int k = 0; k < 10'000; ++k) chain += " and state=done";
  EXPECT_TRUE(holds(chain)) << "a long chain is not deep";
}

/// The independent evaluator: an expression as it is made, with its truth worked out along the way.
struct Made {
  std::string text;
  std::function<bool(const ResultRow&)> truth;
};

Made made_expression(int depth);

template <class T>
bool related(const T& left, const std::string& op, const T& right) {
  return (left == right && op.find('=') != std::string::npos && op != "!=") || (left < right && op[0] == '<') ||
         (right < left && op[0] == '>') || (!(left == right) && op == "!=");
}

Made made_comparison() {
  const bool is_text = *rc::gen::inRange(0, 4) == 0;
  if (is_text) {
    const std::string value = *rc::gen::element<std::string>("done", "queued", "failed");
    const std::string op = *rc::gen::element<std::string>("=", "==", "!=");
    return {"state" + op + value, [op, value](const ResultRow& row) {
              return row.fields.contains("state") && related<std::string>(row.fields["state"], op, value);
            }};
  }
  const std::string field = *rc::gen::element<std::string>("rods.length", "order.mean", "n_rods");
  const std::string op = *rc::gen::element<std::string>("=", "==", "!=", "<", "<=", ">", ">=");
  const int tenths = *rc::gen::inRange(-3, 4);
  std::string value = std::to_string(tenths) + "e-1";
  if (field == "rods.length") {
    value = *rc::gen::element(value, std::to_string(tenths) + "00 um", std::to_string(tenths) + "e-2cm");
  }
  return {field + *rc::gen::element<std::string>("", " ") + op + *rc::gen::element<std::string>("", "  ") + value,
          [field, op, tenths](const ResultRow& row) {
            return row.fields.contains(field) &&
                   related(std::lround(row.fields[field].get<double>() * 10), op, static_cast<long>(tenths));
          }};
}

Made made_expression(int depth) {
  const int kind = depth == 0 ? 0 : *rc::gen::inRange(0, 5);
  if (kind == 0) return made_comparison();
  const Made left = made_expression(depth - 1);
  if (kind == 1) return {"not (" + left.text + ")", [left](const auto& row) { return !left.truth(row); }};
  if (kind == 2) return {"( " + left.text + " )", left.truth};
  const Made right = made_expression(depth - 1);
  const bool is_and = kind == 3;
  // In parentheses where what binds less stands in what binds more.
  const auto part = [is_and](const Made& made) { return is_and ? "(" + made.text + ")" : made.text; };
  return {part(left) + (is_and ? " and " : " or ") + part(right), [left, right, is_and](const auto& row) {
            return is_and ? left.truth(row) && right.truth(row) : left.truth(row) || right.truth(row);
          }};
}

ResultRow made_row() {
  ResultRow row;
  const auto some = [] { return *rc::gen::inRange(0, 4) > 0; };
  if (some()) row.fields["state"] = *rc::gen::element<std::string>("done", "queued", "failed");
  for (const char* field : {"rods.length", "order.mean", "n_rods"}) {
    if (some()) row.fields[field] = *rc::gen::inRange(-3, 4) / 10.0;
  }
  return row;
}

TEST(Where, AgreesWithAnIndependentEvaluator) {
  EXPECT_TRUE(rc::check([] {
    const Made made = made_expression(4);
    const std::vector<ResultRow> rows{made_row(), made_row(), made_row(),
                                      row_of({{"state", "x"}, {"rods.length", 9}, {"order.mean", 9}, {"n_rods", 9}})};
    auto where = Where::parse(made.text);
    RC_ASSERT(static_cast<bool>(where));
    RC_ASSERT(where->bind(rows).empty());
    for (const ResultRow& row : rows) RC_ASSERT(where->matches(row) == made.truth(row));
  }));
}

TEST(Where, AnyTextIsReadOrRefusedWithPlacesInIt) {
  EXPECT_TRUE(rc::check([] {
    const auto words = *rc::gen::container<std::vector<std::string>>(
        rc::gen::element<std::string>("(", ")", "and", "or", "not", "state", "order.mean", "=", "<=", "!", "done",
                                      "0.5", "mm", "'", "\"", " ", "\xff"));
    std::string text;
    for (const std::string& word : words) text += word + (*rc::gen::arbitrary<bool>() ? " " : "");
    auto where = Where::parse(text);
    if (!where) {
      RC_ASSERT(!where.error().empty());
      for (const WhereProblem& problem : where.error()) RC_ASSERT(problem.at <= text.size());
    } else if (where->bind({done(), queued()}).empty()) {
      (void)where->matches(done());
    }
  }));
}

}  // namespace
}  // namespace shaken::client
