// SPDX-License-Identifier: MIT
#include "study/report.h"

#include <gtest/gtest.h>

#include "base/failure.h"
#include "tests/unit/study/made_up_run.h"

namespace shaken::study {
namespace {

TEST(Origin, NamesTheVersionsThatMadeTheRuns) {
  const auto by = [](const char* version, const char* finished) {
    return MadeUp(4.5, 0.75)
        .number(Json::json_pointer("/versions/shaken"), version)
        .number(Json::json_pointer("/finished"), finished);
  };
  const Library runs =
      library_of({{"phases", {by("1.0", "2026-01-02"), by("1.0", "2026-01-03"), by("1.1", "2026-02-01")}}});
  const std::string_view sweeps[] = {"phases"};
  EXPECT_EQ(origin_text(runs, sweeps),
            "- 2 runs by shaken 1.0, the last of them finished at 2026-01-03\n"
            "- 1 runs by shaken 1.1, the last of them finished at 2026-02-01\n");
  EXPECT_EQ(versions_of(runs, sweeps).size(), 2u);
}

TEST(Report, TableGoesBetweenTheMarks) {
  const std::string document = "a\n<!-- measured: begin -->\nold\n<!-- measured: end -->\nb\n";
  EXPECT_EQ(with_section(document, "measured", "new\n"),
            "a\n<!-- measured: begin -->\nnew\n<!-- measured: end -->\nb\n");
  EXPECT_THROW(with_section("no marks", "measured", "new\n"), Failure);
}

}  // namespace
}  // namespace shaken::study
