#include "base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "base/progress_line.h"
#include "base/table.h"

namespace shaken {
namespace {

using namespace std::string_literals;

TEST(DisplayWidth, CountsCharactersNotBytesNorColours) {
  EXPECT_EQ(display_width(""), 0u);
  EXPECT_EQ(display_width("abc"), 3u);
  EXPECT_EQ(display_width("Γ=7 ⟨S⟩"), 7u);
  EXPECT_EQ(display_width("\x1b[31mred\x1b[0m"), 3u);
}

TEST(Fitted, CutsWithEllipsisAndEndsColours) {
  EXPECT_EQ(fitted("abcdef", 6), "abcdef");
  EXPECT_EQ(fitted("abcdef", 5), "abcd…");
  EXPECT_EQ(fitted("abcdef", 0), "abcdef");
  EXPECT_EQ(fitted("ΓΓΓΓ", 3), "ΓΓ…");
  EXPECT_EQ(fitted("\x1b[31mabcdef\x1b[0m", 3), "\x1b[31mab…\x1b[0m");
}

TEST(Printable, HarmlessTextStaysAsItIs) {
  for (const char* text :
       {"", "abc", "Γ = 7, ⟨S⟩ \\ \"x\"", "\xF0\x9F\xA6\x80", "\u0915", "\u00a0\u2065\u206a\u2029\u202f"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(printable(text, Lines::kMany), text);
  }
}

TEST(Printable, NothingATerminalObeysIsLeftButLinesAndTabsWhereTheyAreMeant) {
  EXPECT_EQ(printable("a\x1b[2Jb"), "a\\u001b[2Jb");
  EXPECT_EQ(printable("\x1b]0;title\x07"), "\\u001b]0;title\\u0007");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\u0000b");
  EXPECT_EQ(printable("\x7f"), "\\u007f");
  EXPECT_EQ(printable("\u0080\u009b31m\u009f"), "\\u0080\\u009b31m\\u009f");
  EXPECT_EQ(printable("\u202a\u202e\u2066\u2069"), "\\u202a\\u202e\\u2066\\u2069");
  EXPECT_EQ(printable("a\n\tb\r"), "a\\u000a\\u0009b\\u000d");
  EXPECT_EQ(printable("a\n\tb\r\x1b", Lines::kMany), "a\n\tb\\u000d\\u001b");
}

TEST(Printable, BytesThatAreNoUtf8AreShown) {
  EXPECT_EQ(printable("\x9b"), "\\x9b");             // C1 as one byte
  EXPECT_EQ(printable("a\xff\xc3"), "a\\xff\\xc3");  // cut short
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b");    // longer than needed
  EXPECT_EQ(printable("\xe0\x82\x9b"), "\\xe0\\x82\\x9b");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond the last character
  EXPECT_EQ(printable("\xf8"), "\\xf8");
}

TEST(DurationText, KnownAnswers) {
  const auto words = nlohmann::json::parse(std::ifstream(SHAKEN_SOURCE_DIR "/tests/vectors/words.json"));
  for (const auto& one : words["duration_text"])
    EXPECT_EQ(duration_text(one[0].is_null() ? NAN : one[0].get<double>()), one[1]);
  for (const auto& one : words["bytes_text"]) EXPECT_EQ(bytes_text(one[0]), one[1]);
  EXPECT_EQ(duration_text(INFINITY), "?");
  for (const auto& one : words["value_text"]) {
    const std::string text = one[2], plain = std::regex_replace(text, std::regex("±"), "+-");
    EXPECT_EQ(with_error(one[0], one[1]), plain);
  }
  EXPECT_EQ(with_error(0.8801, NAN), "0.88 (error unknown)");
}

TEST(ClockText, TimeOrDayOrDate) {
  setenv("TZ", "UTC", 1);
  tzset();
  const std::int64_t noon = 1'700'000'000LL / 86400 * 86400 * 1'000'000 + 12LL * 3600 * 1'000'000;  // Tue 2023-11-14
  EXPECT_EQ(clock_text(90 * 60, noon), "13:30");
  EXPECT_EQ(clock_text(20 * 3600, noon), "Wed 08:00");
  EXPECT_EQ(clock_text(10 * 86400, noon), "2023-11-24");
  EXPECT_EQ(clock_text(-1, noon), "?");
}

TEST(NumberText, CountsInFullRestShort) {
  EXPECT_EQ(number_text(2109), "2109");
  EXPECT_EQ(number_text(0.91344), "0.9134");
  EXPECT_EQ(number_text(2500000), "2.5e+06");
  EXPECT_EQ(number_text(NAN), "-");
}

TEST(BarText, FillsInEighths) {
  EXPECT_EQ(bar_text(0, 4), "····");
  EXPECT_EQ(bar_text(1, 4), "████");
  EXPECT_EQ(bar_text(0.5, 4), "██··");
  EXPECT_EQ(bar_text(0.5 + 1.0 / 32, 4), "██▏·");
  EXPECT_EQ(bar_text(7, 2), "██");
  EXPECT_EQ(bar_text(NAN, 2), "··");
}

TEST(Split, LeavesOutWhatIsEmpty) {
  using Parts = std::vector<std::string>;
  EXPECT_EQ(split("/v1//jobs/", '/'), (Parts{"v1", "jobs"}));
  EXPECT_EQ(split("one", '/'), Parts{"one"});
  EXPECT_EQ(split("//", '/'), Parts{});
  EXPECT_EQ(split("", '/'), Parts{});
}

TEST(ShellWord, IsQuotedWhereTheShellWouldNotLeaveItAlone) {
  EXPECT_EQ(shell_word("runs/a-1.b"), "runs/a-1.b");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("my runs/ü"), "'my runs/ü'");
  EXPECT_EQ(shell_word("it's; $(x) `y` \\ \"\n"), "'it'\\''s; $(x) `y` \\ \"\n'");
}

TEST(CsvField, QuotesOnlyWhereNeeded) {
  EXPECT_EQ(csv_field("plain text"), "plain text");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_field("two\nlines"), "\"two\nlines\"");
}

TEST(Base64, IsThatOfRfc4648) {
  const char* const kVectors[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  for (std::size_t n = 0; n < std::size(kVectors); ++n) EXPECT_EQ(base64("foobar"s.substr(0, n)), kVectors[n]);
  EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

TEST(WrappedHelp, BreaksProseAndDescriptionsButNoCommands) {
  const std::string text = "Usage: shaken\n\n  -o,--out FILE   Where to write\n";
  EXPECT_EQ(wrapped_help(text), text);
  EXPECT_EQ(wrapped_help("  -o FILE    where the picture goes\n  -x    y\n", 25),
            "  -o FILE    where the\n             picture goes\n  -x    y\n");
  EXPECT_EQ(
      wrapped_help("  shaken picture RUN RUN RUN --style layers -o x.png   three runs side by side, one headline", 60),
      "  shaken picture RUN RUN RUN --style layers -o x.png\n"
      "                              three runs side by side, one\n                              headline")
      << "a description far to the right gets lines of its own";
  EXPECT_EQ(wrapped_help("one two three four", 9), "one two\nthree\nfour");
  EXPECT_EQ(wrapped_help("  shaken submit scene.json", 10), "  shaken submit scene.json");
  EXPECT_EQ(wrapped_help("µµµ µµµ µµµ", 7), "µµµ µµµ\nµµµ") << "columns, not bytes";
}

TEST(Number, IsTheWholeText) {
  EXPECT_EQ(number_in<int>("-12"), -12);
  EXPECT_EQ(number_in<std::size_t>("12"), 12u);
  for (const char* text : {"", " 1", "1 ", "1.5", "x", "99999999999"}) EXPECT_FALSE(number_in<int>(text)) << text;
  EXPECT_FALSE(number_in<std::size_t>("-1"));
}

TEST(RunId, IsSixteenHexDigits) {
  EXPECT_TRUE(is_id("1f0c000000000000"));
  for (const char* text :
       {"", "..", "1f0c", "1F0C000000000000", "1f0c00000000000g", "1f0c0000000000000", "../../etc/passw"}) {
    EXPECT_FALSE(is_id(text)) << text;
  }
}

TEST(TableText, AlignsColumns) {
  Table table({{"NAME"}, {"N", Table::Align::kRight}});
  table.add_row({"Γ", "5"});
  table.add_row({"longer", "12345"});
  EXPECT_EQ(table.text(0),
            "NAME        N\n"
            "Γ           5\n"
            "longer  12345\n");
}

TEST(TableText, NarrowTerminalShortensTheWidestColumn) {
  Table table({{"ID"}, {"POINT"}});
  table.add_row({"1f0c", "rods.length=2.5 rods.area_fraction=0.6"});
  const std::string text = table.text(20);
  EXPECT_EQ(text, "ID    POINT\n1f0c  rods.length=2…\n");
  // No column becomes narrower than 4, whatever the terminal.
  EXPECT_EQ(table.text(1), "ID    POI…\n1f0c  rod…\n");
  Table numbers({{"JOB"}, {"S", Table::Align::kRight}});
  numbers.add_row({"1f0c5e2a", "0.9496"});
  EXPECT_EQ(numbers.text(5), "JOB            S\n1f0c5e2a  0.9496\n");
}

TEST(ProgressLine, IsWrittenOverOnATerminalAndWipedAtTheEnd) {
  std::ostringstream out;
  {
    ProgressLine line(out, true, 12, 0);
    line.show("a long line of text");
    EXPECT_EQ(out.str(), "\ra long lin…\x1b[K");
    line.show("too soon after the last one");
    EXPECT_EQ(out.str(), "\ra long lin…\x1b[K");
  }
  EXPECT_EQ(out.str(), "\ra long lin…\x1b[K\r\x1b[K");
}

TEST(ProgressLine, TheLastOneStaysAndIsNeverTooSoon) {
  std::ostringstream out;
  ProgressLine line(out, true, 80, 0);
  line.show("half");
  line.end_with("done");
  EXPECT_EQ(out.str(), "\rhalf\x1b[K\r\x1b[Kdone\n");
}

TEST(ProgressLine, LogsGetALineNowAndThenOrNone) {
  std::ostringstream often, never;
  ProgressLine every_nanosecond(often, false, 0, 1e-9);
  every_nanosecond.show(
      "a line that is longer than a terminal is wide, which a log does not mind at all, whatever it says");
  EXPECT_EQ(often.str(),
            "a line that is longer than a terminal is wide, which a log does not mind at all, whatever it says\n");
  ProgressLine none(never, false, 0, 0);
  none.show("half");
  EXPECT_EQ(never.str(), "");
  none.end_with("done");
  EXPECT_EQ(never.str(), "done\n");
}

TEST(RoundLength, IsTheLongestOneTwoFive) {
  EXPECT_DOUBLE_EQ(round_length(1), 1);
  EXPECT_DOUBLE_EQ(round_length(1.99), 1);
  EXPECT_DOUBLE_EQ(round_length(2), 2);
  EXPECT_DOUBLE_EQ(round_length(4.9), 2);
  EXPECT_DOUBLE_EQ(round_length(7), 5);
  EXPECT_DOUBLE_EQ(round_length(37), 20);
  EXPECT_DOUBLE_EQ(round_length(0.3), 0.2);
}

}  // namespace
}  // namespace shaken
