// SPDX-License-Identifier: MIT
#include "base/table.h"

#include <gtest/gtest.h>

namespace shaken {
namespace {

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

}  // namespace
}  // namespace shaken
