// SPDX-License-Identifier: MIT
#include "client/print.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "client/console.h"

namespace shaken::client {
namespace {

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

TEST(DurationText, KnownAnswers) {
  EXPECT_EQ(duration_text(0), "0.0 s");
  EXPECT_EQ(duration_text(0.44), "0.4 s");
  EXPECT_EQ(duration_text(12.3), "12 s");
  EXPECT_EQ(duration_text(59.7), "1 min 00 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(3599.9), "1 h 00 min");
  EXPECT_EQ(duration_text(7500), "2 h 05 min");
  EXPECT_EQ(duration_text(3 * 86400 + 4 * 3600), "3 d 04 h");
  EXPECT_EQ(duration_text(-1), "?");
  EXPECT_EQ(duration_text(NAN), "?");
  EXPECT_EQ(duration_text(INFINITY), "?");
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

TEST(CsvField, QuotesOnlyWhereNeeded) {
  EXPECT_EQ(csv_field("plain text"), "plain text");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_field("two\nlines"), "\"two\nlines\"");
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
}

TEST(TableText, NumbersAndNamesAreLeftOutWholeButNeverCut) {
  using Align = Table::Align;
  Table table({{"JOB"}, {"S", Align::kRight}, {"OVERLAP", Align::kRight, 2}, {"CPU s", Align::kRight, 1}});
  table.add_row({"1f0c5e2a", "0.9496", "0.003418", "12.25"});
  EXPECT_EQ(table.text(33), "JOB            S   OVERLAP  CPU s\n1f0c5e2a  0.9496  0.003418  12.25\n");
  EXPECT_EQ(table.text(32), "JOB            S  CPU s\n1f0c5e2a  0.9496  12.25\n");
  EXPECT_EQ(table.left_out(32), std::vector<std::string>{"OVERLAP"});
  EXPECT_EQ(table.text(5), "JOB            S\n1f0c5e2a  0.9496\n") << "what has to stay, stays whole";
  EXPECT_TRUE(table.left_out(0).empty());
}

TEST(Agrees, AsksUntilTheAnswerIsClear) {
  std::ostringstream out;
  std::istringstream answers("perhaps\nn\n\ny\n");
  const Console console{.out = out, .err = out, .in = &answers};
  EXPECT_FALSE(console.agrees("Go on?", true));
  EXPECT_EQ(out.str(), "Go on? [Y/n] Go on? [Y/n] ");
  EXPECT_TRUE(console.agrees("Go on?", true)) << "an empty answer";
  EXPECT_TRUE(console.agrees("Go on?", false));
  EXPECT_FALSE(console.agrees("Go on?", false)) << "no answer at all";
}

TEST(Painted, ColoursOnlyWhereWanted) {
  std::ostringstream out;
  Console console{.out = out, .err = out};
  EXPECT_EQ(console.painted(Colour::kRed, "x"), "x");
  console.colour = true;
  EXPECT_EQ(console.painted(Colour::kRed, "x"), "\x1b[31mx\x1b[0m");
  EXPECT_EQ(console.painted(Colour::kPlain, "x"), "x");
}

}  // namespace
}  // namespace shaken::client
