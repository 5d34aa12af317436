#include "base/keys/document.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <vector>

#include "base/keys/markdown.h"
#include "base/keys/nearest.h"

namespace shaken::keys {
namespace {

std::optional<Node> parse(std::string_view text, std::vector<Problem>& problems) {
  return parse_document(text, "f", problems);
}

std::string error_of(std::string_view text) {
  std::vector<Problem> problems;
  EXPECT_FALSE(parse(text, problems)) << text;
  return to_string(problems);
}

std::string place(const Place& at) { return std::to_string(at.line) + ":" + std::to_string(at.column); }

TEST(Document, KnowsWhereEverythingStands) {
  std::vector<Problem> problems;
  const auto root = parse(
      "\xef\xbb\xbf{ // comment, with \"quotes\" and { braces\n"
      "  \"a\": 1.50, /* { \n */ \"b\" : [true,\n    null, \"x\\\"y,\", -2e3/**/],\n"
      "\t\"\u00e9\u00e9\": {\"c\":{}}\r\n}",
      problems);
  ASSERT_TRUE(root) << to_string(problems);
  EXPECT_EQ(place(root->place), "1:1");
  EXPECT_EQ(place(root->members[0].place), "2:3");
  EXPECT_EQ(place(root->members[0].value.place), "2:8");
  EXPECT_EQ(root->members[0].value.text, "1.50");
  const Member& b = root->members[1];
  EXPECT_EQ(place(b.place), "3:5");
  EXPECT_EQ(place(b.value.place), "3:11");
  EXPECT_EQ(place(b.value.items[0].place), "3:12");
  EXPECT_TRUE(b.value.items[0].boolean);
  EXPECT_EQ(place(b.value.items[1].place), "4:5");
  EXPECT_EQ(place(b.value.items[2].place), "4:11");
  EXPECT_EQ(b.value.items[2].text, "x\"y,");
  EXPECT_EQ(place(b.value.items[3].place), "4:20");
  EXPECT_EQ(b.value.items[3].text, "-2e3");
  const Member& accents = root->members[2];
  EXPECT_EQ(place(accents.place), "5:2");
  EXPECT_EQ(place(accents.value.place), "5:8");  // columns count characters, not bytes
  EXPECT_EQ(place(accents.value.members[0].place), "5:9");
  EXPECT_EQ(place(accents.value.members[0].value.place), "5:13");
}

// The parser ends a comment at a carriage return alone, too.
TEST(Document, CommentsEndWhereTheParserEndsThem) {
  for (const char end : {'\n', '\r'}) {
    std::vector<Problem> problems;
    const auto root = parse(std::string("{ // a \"quote") + end + "\"key\": \"text\"} // more", problems);
    ASSERT_TRUE(root) << to_string(problems);
    EXPECT_EQ(root->members[0].value.text, "text");
    EXPECT_EQ(place(root->members[0].value.place), end == '\n' ? "2:8" : "1:22");
  }
  std::vector<Problem> none;
  const auto blocks = parse("{ /*/ \"a\" //*//* \"b\" */ \"key\": 1}", none);
  ASSERT_TRUE(blocks) << to_string(none);
  EXPECT_EQ(place(blocks->members[0].value.place), "1:32");
  EXPECT_EQ(error_of("// \"quote\r1 \"x\": \"12"),
            "f:1:15: syntax error while parsing value - unexpected string literal; expected end of input\n");
}

TEST(Document, SyntaxErrorsSayWhere) {
  EXPECT_EQ(error_of("{\"a\": 1,}"),
            "f:1:9: syntax error while parsing object key - unexpected '}'; expected string literal\n");
  EXPECT_EQ(error_of("{\n  \"a\": NaN}"), "f:2:8: syntax error: NaN is not a number\n");
  EXPECT_EQ(error_of("{\"a\": -Infinity}"), "f:1:7: syntax error: -Infinity is not a number\n");
  EXPECT_EQ(error_of("{} x"), "f:1:4: syntax error while parsing value - invalid literal; expected end of input\n");
  EXPECT_EQ(error_of("{}\n{}"), "f:2:1: syntax error while parsing value - unexpected '{'; expected end of input\n");
  EXPECT_EQ(error_of(""),
            "f:1:1: syntax error while parsing value - unexpected end of input; expected '[', '{', or a "
            "literal\n");
  EXPECT_EQ(
      error_of("{\"a\": \"b\n"),
      "f:1:9: syntax error while parsing value - invalid string: control character U+000A (LF) must be escaped to "
      "\\u000A or \\n\n");
  EXPECT_EQ(error_of("{\"a\": 01}"),
            "f:1:7: syntax error while parsing object - unexpected number literal; expected '}'\n");
  EXPECT_EQ(error_of("{\"a\": 1e999}"), "f:1:7: syntax error number overflow parsing '1e999'\n");
  EXPECT_EQ(error_of("{\"a\": 1 /* }"),
            "f:1:13: syntax error while parsing object - invalid comment; missing closing '*/'; expected '}'\n");
  EXPECT_EQ(error_of(std::string_view("{}\0 x", 5)), "f:1:3: syntax error: NUL character\n");
  EXPECT_EQ(error_of("[\"\xff\"]"),
            "f:1:3: syntax error while parsing value - invalid string: ill-formed UTF-8 byte\n");
}

TEST(Document, DuplicateKeysAreProblemsAndTheFirstCounts) {
  std::vector<Problem> problems;
  const auto root = parse("{\"a\": {\"b\": 1,\n \"b\": 2}, \"a\": 3}", problems);
  ASSERT_TRUE(root);
  EXPECT_EQ(to_string(problems),
            "f:2:2: /a/b: duplicate key, first given at 1:8\n"
            "f:2:11: /a: duplicate key, first given at 1:2\n");
  EXPECT_EQ(root->find("a")->value.find("b")->value.text, "1");
}

TEST(Document, RefusesDeepNesting) {
  const std::string deep(100000, '[');
  EXPECT_EQ(error_of(deep), "f:1:65: nested more than 64 deep\n");
}

/// Straight from the definition, exponential.
std::size_t slow_distance(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return std::max(a.size(), b.size());
  const auto cut = [](const std::string& s, std::size_t n) { return s.substr(0, s.size() - n); };
  std::size_t least = std::min({slow_distance(cut(a, 1), b) + 1, slow_distance(a, cut(b, 1)) + 1,
                                slow_distance(cut(a, 1), cut(b, 1)) + (a.back() == b.back() ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && a[a.size() - 2] == b.back()) {
    least = std::min(least, slow_distance(cut(a, 2), cut(b, 2)) + 1);
  }
  return least;
}

TEST(Nearest, DistanceAgreesWithItsDefinition) {
  const auto word = rc::gen::resize(5, rc::gen::container<std::string>(rc::gen::elementOf(std::string("abc"))));
  EXPECT_TRUE(rc::check("distance", [&] {
    const std::string a = *word;
    const std::string b = *word;
    RC_ASSERT(edit_distance(a, b) == slow_distance(a, b));
  }));
}

TEST(Nearest, IsTheFirstOfThoseAtTheLeastDistance) {
  const auto word = rc::gen::resize(6, rc::gen::container<std::string>(rc::gen::elementOf(std::string("abc"))));
  EXPECT_TRUE(rc::check("nearest", [&] {
    const std::string wanted = *word;
    const auto names = *rc::gen::container<std::vector<std::string>>(rc::gen::nonEmpty(word));
    RC_PRE(!names.empty());
    const auto first = std::min_element(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
      return edit_distance(wanted, a) < edit_distance(wanted, b);
    });
    const std::string found = nearest(wanted, names);
    RC_ASSERT(found.empty() || found == *first);
  }));
}

TEST(Nearest, FindsSlipsOfThePenOnly) {
  const std::vector<std::string> names{"length", "mid_diameter", "end_diameter", "area_fraction"};
  EXPECT_EQ(nearest("lenght", names), "length");
  EXPECT_EQ(nearest("Length", names), "length");
  EXPECT_EQ(nearest("area_fracton", names), "area_fraction");
  EXPECT_EQ(nearest("diameter", names), "mid_diameter");
  EXPECT_EQ(nearest("colour", names), "");
  EXPECT_EQ(nearest("x", names), "");
  EXPECT_EQ(nearest("anything", std::vector<std::string>{}), "");
}

TEST(Markdown, KeepsABarWithinItsCell) {
  EXPECT_EQ(table_head({"a", "b"}) + table_line({"⟨|v|⟩", ""}), "| a | b |\n|---|---|\n| ⟨\\|v\\|⟩ |  |\n");
}

}  // namespace
}  // namespace shaken::keys
