#include "run/files/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "tests/support/good.h"

namespace shaken::run {
namespace {

TEST(Progress, ComesBackFromItsFile) {
  const ScratchFolder folder;
  const Progress written{"failed", "numerical \"trouble\"\n\xff", 4711, 2109, 1.25, 10, 0.0123, -1, 0.5, 0.875, 0.75,
                         1e-5};
  ASSERT_TRUE(write_progress(folder / "progress.json", written));
  const auto read = test::good(read_progress(folder / "progress.json"));
  EXPECT_EQ(read->state, "failed");
  EXPECT_EQ(read->message.substr(0, 20), "numerical \"trouble\"\n") << "bytes that are not UTF-8 are replaced";
  EXPECT_EQ(read->pid, 4711);
  EXPECT_EQ(read->n_rods, 2109);
  EXPECT_EQ(read->sim_time, 1.25);
  EXPECT_EQ(read->sim_time_total, 10);
  EXPECT_EQ(read->sim_rate, 0.0123);
  EXPECT_EQ(read->eta, -1);
  EXPECT_EQ(read->drawn, 0.5);
  EXPECT_EQ(read->order, 0.875);
  EXPECT_EQ(read->order_running_mean, 0.75);
  EXPECT_EQ(read->max_overlap, 1e-5);
  EXPECT_EQ(read->fraction(), 0.125);
}

TEST(Progress, WhatSpheresDoNotHaveIsNull) {
  const ScratchFolder folder;
  Progress written;
  written.order = written.order_running_mean = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(write_progress(folder / "progress.json", written));
  EXPECT_NE(read_file(folder / "progress.json")->find("\"order\": null"), std::string::npos);
  const auto read = test::good(read_progress(folder / "progress.json"));
  EXPECT_TRUE(std::isnan(read->order));
  EXPECT_TRUE(std::isnan(read->order_running_mean));
}

TEST(Progress, OtherFilesAreRefusedWithTheirName) {
  const ScratchFolder folder;
  for (const char* text : {"", "{", "[]", "{}", R"({"state": 1})"}) {
    ASSERT_TRUE(write_file_atomically(folder / "progress.json", text));
    EXPECT_THAT(test::refusal(read_progress(folder / "progress.json")), testing::HasSubstr("progress.json")) << text;
  }
}

}  // namespace
}  // namespace shaken::run
