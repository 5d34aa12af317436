// SPDX-License-Identifier: MIT
#include "server/queue/stop_rule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shaken::server {
namespace {

bool is_broken(const std::string& rule, std::int64_t done, std::int64_t failed) {
  JobCounts counts;
  counts[JobState::kDone] = done;
  counts[JobState::kFailed] = failed;
  counts[JobState::kQueued] = 100;
  counts[JobState::kCancelled] = 100;
  return StopRule::parse(rule)->is_broken(counts);
}

TEST(StopRuleTest, ANumberIsJudgedAtOnce) {
  EXPECT_FALSE(is_broken("failed>3", 0, 3));
  EXPECT_TRUE(is_broken("failed>3", 0, 4));
  EXPECT_TRUE(is_broken("failed>0", 0, 1));
  EXPECT_FALSE(is_broken("failed>0", 100, 0));
}

TEST(StopRuleTest, APercentageIsJudgedOnceFiveHaveEnded) {
  EXPECT_FALSE(is_broken("failed>10%", 0, 4));
  EXPECT_TRUE(is_broken("failed>10%", 0, 5));
  EXPECT_TRUE(is_broken("failed>10%", 4, 1));
  EXPECT_FALSE(is_broken("failed>10%", 9, 1)) << "no more than 10 %";
  EXPECT_TRUE(is_broken("failed>10%", 8, 1));
  EXPECT_FALSE(is_broken("failed>0%", 5, 0));
  EXPECT_TRUE(is_broken("failed>12.5%", 6, 1));
  EXPECT_FALSE(is_broken("failed>12.5%", 7, 1));
}

TEST(StopRuleTest, ItsTextGivesItAgain) {
  for (const char* text : {"failed>10%", "failed>0%", "failed>12.5%", "failed>3", "failed>0", "failed>1000000"}) {
    const auto rule = StopRule::parse(text);
    ASSERT_TRUE(rule) << text;
    EXPECT_EQ(StopRule::parse(rule->text())->text(), rule->text());
  }
  EXPECT_EQ(StopRule::parse(" failed > 10 % ")->text(), "failed>10%");
}

TEST(StopRuleTest, AnythingElseIsRefusedWithAnExample) {
  for (const char* text : {"", "failed", "failed>", "failed>%", "done>3", "failed<3", "failed>=3", "failed>-1",
                           "failed>-0", "failed>100%", "failed>2.5", "failed>1e3", "failed>nan", "failed>inf%",
                           "failed>3%%", "failed>99999999999999999999", "FAILED>3", "failed>3 jobs"}) {
    const auto rule = StopRule::parse(text);
    ASSERT_FALSE(rule) << text;
    EXPECT_THAT(rule.error().message, testing::HasSubstr("failed>10%"));
  }
}

}  // namespace
}  // namespace shaken::server
