#include "scene/keys/values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using testing::ElementsAre;

std::optional<Node> node_of(const std::string& json, std::vector<Problem>& problems) {
  return parse_document(json, "f", problems);
}

std::vector<std::string> values(const std::string& json, std::string_view path = "rods.length") {
  std::vector<Problem> problems;
  Room room;
  std::vector<std::string> texts;
  for (const Node& value : read_values(field_at(path), *node_of(json, problems), room, problems))
    texts.push_back(value.text);
  EXPECT_EQ(to_string(problems), "") << json;
  return texts;
}

std::string problem_with(const std::string& json, std::string_view path = "rods.length") {
  std::vector<Problem> problems;
  Room room;
  read_values(field_at(path), *node_of(json, problems), room, problems);
  return problems.size() == 1 ? problems.front().message : to_string(problems);
}

TEST(Values, RangesAreExactDecimals) {
  EXPECT_THAT(values("\"0.45:0.85:0.05\""),
              ElementsAre("0.45", "0.5", "0.55", "0.6", "0.65", "0.7", "0.75", "0.8", "0.85"));
  EXPECT_THAT(values("\"2.5:4.5:0.5 mm\""), ElementsAre("2.5 mm", "3 mm", "3.5 mm", "4 mm", "4.5 mm"));
  EXPECT_THAT(values("\" 2.5 mm : 3 mm : 0.25 mm \""), ElementsAre("2.5 mm", "2.75 mm", "3 mm"));
  EXPECT_THAT(values("\"1:0:-0.5\""), ElementsAre("1", "0.5", "0"));
  EXPECT_THAT(values("\"1:2:0.4\""), ElementsAre("1", "1.4", "1.8"));  // the end is left out where no step meets it
  EXPECT_THAT(values("\"3:3:1\""), ElementsAre("3"));
  EXPECT_THAT(values("\"1e-6:3e-6:1e-6\""), ElementsAre("0.000001", "0.000002", "0.000003"));
  EXPECT_THAT(values(R"({"from": 0.1, "to": "0.3 mm", "step": 0.1})"), ElementsAre("0.1 mm", "0.2 mm", "0.3 mm"));
  EXPECT_THAT(values(R"({"from": 0.45, "to": 0.85, "n": 5})"), ElementsAre("0.45", "0.55", "0.65", "0.75", "0.85"));
  EXPECT_THAT(values(R"({"from": 0, "to": 1, "n": 4})"), ElementsAre("0", "0.333333333333", "0.666666666667", "1"));
  EXPECT_THAT(values(R"({"from": 2, "to": 7, "n": 1})"), ElementsAre("2"));
}

TEST(Values, RangesOfAnyStepAreTheDecimalsOfTheirIndex) {
  EXPECT_TRUE(rc::check("the i-th value is (from + i step) to the last bit", [] {
    const auto from = *rc::gen::inRange<std::int64_t>(-100000, 100000);
    const auto step = *rc::gen::inRange<std::int64_t>(1, 5000);
    const auto n = *rc::gen::inRange<std::int64_t>(1, 200);
    const auto text = [](std::int64_t thousandths) { return make_decimal(thousandths, -3).text(); };
    const auto found = values('"' + text(from) + ":" + text(from + (n - 1) * step) + ":" + text(step) + '"');
    RC_ASSERT(found.size() == static_cast<std::size_t>(n));
    for (std::int64_t i = 0; i < n; ++i) {
      RC_ASSERT(parse_decimal(found[static_cast<std::size_t>(i)])->value() ==
                static_cast<double>(from + i * step) / 1000);
    }
  }));
}

TEST(Values, ArraysMixValuesAndRanges) {
  EXPECT_THAT(values(R"([0.3, "0.5:0.7:0.1", "2 mm"])"), ElementsAre("0.3", "0.5", "0.6", "0.7", "2 mm"));
  EXPECT_THAT(values("4.5"), ElementsAre("4.5"));
  EXPECT_EQ(values("[[640, 480], [1280, 720]]", "movie.size").size(), 2u);
  EXPECT_EQ(values("[640, 480]", "movie.size").size(), 1u);
  EXPECT_THAT(values(R"(["aligned", "random"])", "rods.start"), ElementsAre("aligned", "random"));
}

TEST(Values, BadRangesSayWhy) {
  EXPECT_EQ(problem_with("\"1:2\""), "\"1:2\" is not a range; write from:to:step");
  EXPECT_EQ(problem_with("\"1:2:3:4\""), "\"1:2:3:4\" is not a range; write from:to:step");
  EXPECT_EQ(problem_with("\"1:x:3\""), "\"x\" is not a number");
  EXPECT_EQ(problem_with("\"1:2:0\""), "the step of a range must not be 0");
  EXPECT_EQ(problem_with("\"1:2:-0.1\""), "the step leads away from the end of the range");
  EXPECT_EQ(problem_with("\"1 um:2 mm:0.1 mm\""), "a range in um and mm; write it in one unit");
  EXPECT_EQ(problem_with("\"0:1:1e-6\""), "a range of 1000001 values; at most 100000 are allowed");
  EXPECT_EQ(problem_with("\"0:100000:1\""), "a range of 100001 values; at most 100000 are allowed");
  EXPECT_EQ(problem_with("\"0:1e17:1e-17\""), "the range has too many digits");
  EXPECT_EQ(problem_with("[]"), "no values to sweep over");
  EXPECT_EQ(problem_with(R"({"from": 1, "to": 2})"), "the range lacks \"step\"");
  EXPECT_EQ(
      problem_with(R"({"from": 1, "too": 2, "n": 3})"),
      "f:1:13: /rods/length: unknown key \"too\" in a range; did you mean to?\nf:1:1: /rods/length: the range lacks "
      "\"to\"\n");
  EXPECT_EQ(problem_with(R"({"from": 1, "to": 2, "n": 3, "step": 1})"), "a range takes \"step\" or \"n\", not both");
  EXPECT_EQ(problem_with(R"({"from": 1, "to": 2, "n": 0})"),
            "expected a whole number in [1, 100000], not the number 0");
  EXPECT_EQ(problem_with(R"({"from": [], "to": 2, "n": 2})"), "expected a number, not an array");
}

TEST(Values, ThereIsRoomForSoManyAndNoRangeIsCountedUpBeyondIt) {
  std::string many = "[";
  for (int i = 0; i < 100'000; ++i) many += "\"1:100000:1\", ";
  EXPECT_EQ(problem_with(many + "1]"), "more than 100000 values");
  EXPECT_EQ(values("[\"1:50000:1\", \"1:50000:1\"]").size(), 100'000u);
  EXPECT_EQ(problem_with("[\"1:50000:1\", \"1:50001:1\"]"), "more than 100000 values");
  EXPECT_EQ(problem_with(R"([{"from": 1, "to": 2, "n": 100000}, 1])"), "more than 100000 values");

  std::vector<Problem> problems;
  Room room{150'000};
  const Node range = *node_of("\"1:100000:1\"", problems);
  EXPECT_EQ(read_values(field_at("rods.length"), range, room, problems).size(), 100'000u);
  EXPECT_EQ(read_values(field_at("rods.length"), range, room, problems).size(), 0u);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].message, "the sweep has more than 1000000 values");
}

TEST(Values, ALogarithmicScaleHasEvenRatios) {
  EXPECT_THAT(values(R"({"from": 0.001, "to": "10 mm", "n": 5, "scale": "log"})"),
              ElementsAre("0.001 mm", "0.01 mm", "0.1 mm", "1 mm", "10 mm"));
  EXPECT_THAT(values(R"({"from": 8, "to": 1, "n": 4, "scale": "log"})"), ElementsAre("8", "4", "2", "1"));
  EXPECT_THAT(values(R"({"from": 1, "to": 2, "n": 3, "scale": "linear"})"), ElementsAre("1", "1.5", "2"));
  EXPECT_EQ(problem_with(R"({"from": 0, "to": 2, "n": 3, "scale": "log"})"),
            "a range with \"scale\": \"log\" must lie above 0");
  EXPECT_EQ(problem_with(R"({"from": 1, "to": 2, "n": 3, "scale": "lgo"})"),
            "\"scale\" is \"linear\" or \"log\", not the text \"lgo\"; did you mean log?");
  EXPECT_EQ(problem_with(R"({"from": 1, "to": 2, "n": 3, "scale": true})"),
            "\"scale\" is \"linear\" or \"log\", not true");
  EXPECT_EQ(problem_with(R"({"from": 1, "to": 2, "step": 1, "scale": "log"})"), "unknown key \"scale\" in a range");
}

// Held to the last bit: every machine and compiler has the same values, so that a sweep has the same runs.
TEST(LogScale, TheBitsAreTheSameEverywhere) { EXPECT_EQ(between_on_log_scale(0.3, 70, 0.37), 0x1.20b94d21d30f9p+1); }

TEST(LogScale, IsExactToRounding) {
  EXPECT_TRUE(rc::check("as libm has it", [] {
    const double from = std::pow(10.0, *rc::gen::inRange(-700, 700) / 100.0),
                 ratio = 1 + *rc::gen::inRange(0, 100'000'000) / 10.0;
    const double share = *rc::gen::inRange(0, 1000) / 1000.0;
    const double expected = from * std::pow(ratio, share);
    RC_ASSERT(std::abs(between_on_log_scale(from, from * ratio, share) - expected) < 1e-14 * expected);
  }));
}

}  // namespace
}  // namespace shaken::scene
