// The terms of submissions: what their words, sweeps and percentages mean. What they do to jobs is in
// queue_model_test.cpp.
#include "server/queue/terms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/queue/queue.h"
#include "tests/support/good.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using enum JobState;

class TermsTest : public testing::Test {
 protected:
  static std::string id(char digit) { return std::string(16, digit); }
  Job job(char digit) const { return *queue_.job(id(digit)); }
  std::int64_t submit(const std::string& digits, const Terms& terms = {}, const std::string& name = "") {
    std::vector<NewJob> jobs;
    for (const char digit : digits) jobs.push_back(new_job(digit));
    return queue_.submit(name.empty() ? digits : name, 0, jobs, terms).sweep;
  }
  void end(char digit, JobState state) {
    begin(queue_, id(digit));
    queue_.ended(id(digit), state == kFailed ? JobEvent::kWorkerFailed : JobEvent::kWorkerDone,
                 state == kFailed ? "why" : "");
  }
  /// What may start now, in its order.
  std::string next(const ExecutorRole& executor = {}) const {
    std::string digits;
    for (const Job& each : queue_.next(100, executor)) digits += each.id.front();
    return digits;
  }
  void reopen() {
    queue_.~Queue();
    new (&queue_) Queue(directory_ / "queue.db");
    queue_.recover();
  }

  ScratchFolder directory_;
  Queue queue_{directory_ / "queue.db"};
};

TEST_F(TermsTest, NoMoreOfASweepRunThanMay) {
  submit("abcd", {.at_most = 2});
  submit("e");
  EXPECT_EQ(begin(queue_, id('a')), 1);
  EXPECT_EQ(begin(queue_, id('b')), 1);
  EXPECT_EQ(next(), "e");
  EXPECT_EQ(begin(queue_, id('c')), std::nullopt) << "also when it was looked up before";
  EXPECT_EQ(job('c').reason, "as many jobs of s1 run as may at once");
  EXPECT_EQ(job('e').reason, "");
  queue_.cancel(id('a'));
  EXPECT_EQ(next(), "e") << "one that stops still runs";
  queue_.ended(id('a'), JobEvent::kWorkerStopped, "checkpoint");
  EXPECT_EQ(next(), "cde");
  EXPECT_EQ(job('c').reason, "");
  EXPECT_EQ(queue_.sweep(1)->at_most, 2);
}

TEST_F(TermsTest, AnExecutorTakesWhatNamesItAndTheDefaultTheRest) {
  submit("ab");
  submit("c", {.executor = std::string(kSlurm)});
  submit("d", {.executor = std::string(kLocal)});
  EXPECT_EQ(next(), "abd");
  EXPECT_EQ(next({std::string(kSlurm), false}), "c");
}

TEST_F(TermsTest, WhatComesAfterASweepWaitsUntilItIsDone) {
  const auto first = submit("abc");
  submit("de", {.after = {first, id('c')}});
  EXPECT_EQ(next(), "abc");
  EXPECT_EQ(begin(queue_, id('d')), std::nullopt);
  EXPECT_EQ(job('d').state, kQueued);
  EXPECT_EQ(job('d').reason, "waits for s1: 0 of 3 done, cccccccccccccccc");
  EXPECT_EQ(queue_.history(id('d')).front().cause, "submitted in s2, to come after s1, cccccccccccccccc");
  end('a', kDone);
  end('c', kDone);
  reopen();
  EXPECT_EQ(job('e').reason, "waits for s1: 2 of 3 done");
  EXPECT_EQ(next(), "b");
  end('b', kDone);
  EXPECT_EQ(next(), "de");
  EXPECT_EQ(job('d').reason, "");
  EXPECT_THAT(queue_.sweep(2)->after, testing::ElementsAre("s1", "cccccccccccccccc"));
}

TEST_F(TermsTest, WhatComesAfterSomethingThatCameToNothingSaysSo) {
  const auto first = submit("ab");
  submit("c", {.after = {first}});
  submit("d", {.after = {id('a')}});
  end('a', kFailed);
  EXPECT_EQ(job('c').reason, "it was to come after s1: 1 of 2 failed");
  EXPECT_EQ(queue_.history(id('c')).back().cause, job('c').reason);
  EXPECT_EQ(job('d').reason, "it was to come after aaaaaaaaaaaaaaaa: failed");
}

TEST_F(TermsTest, NothingCanWaitForItselfByWayOfASweep) {
  const auto one = submit("a");
  const auto two = submit("b", {.after = {one}});
  EXPECT_THROW(submit("ca", {.after = {two}}), Conflict);
  EXPECT_THROW(submit("b", {.after = {two}}), Conflict) << "the same sweep again";
  EXPECT_FALSE(queue_.job(id('c')).has_value()) << "nothing has happened";
  end('a', kDone);
  submit("ca", {.after = {one}});
  EXPECT_EQ(next(), "bc") << "what is done does not wait";
  std::vector<NewJob> lost{new_job('a')};
  lost[0].has_results = false;
  EXPECT_THROW(queue_.submit("again", 0, lost, {.after = {one}}), Conflict);
}

TEST_F(TermsTest, ASweepThatFailsTooOftenIsHeld) {
  const auto sweep = submit("abcdefgh", {.stop_if = *StopRule::parse("failed>20%")});
  begin(queue_, id('g'));
  end('a', kFailed);
  for (const char digit : std::string("bcd")) end(digit, kDone);
  EXPECT_EQ(job('h').state, kQueued) << "four are too few to judge";
  end('e', kFailed);
  EXPECT_EQ(job('h').state, kHeld);
  EXPECT_EQ(job('f').state, kHeld);
  EXPECT_EQ(job('g').state, kRunning);
  EXPECT_EQ(job('h').phase, JobPhase::kHeldByRule);
  EXPECT_EQ(job('h').reason, "failed>20%: 2 of 5 jobs that ended have failed; `shaken resume s1` lifts this rule");
  EXPECT_TRUE(queue_.sweep(sweep)->stopped);
  reopen();
  EXPECT_EQ(job('g').state, kQueued) << "it goes on";

  queue_.resume(id('h'));
  end('h', kFailed);
  EXPECT_EQ(job('f').state, kHeld) << "one job alone does not lift the rule";
  EXPECT_EQ(queue_.resume(sweep), 1);
  EXPECT_EQ(queue_.sweep(sweep)->stop_if, "");
  EXPECT_FALSE(queue_.sweep(sweep)->stopped);
  end('f', kFailed);
  EXPECT_EQ(job('g').state, kQueued);

  submit("abcdefgh", {.stop_if = *StopRule::parse("failed>0")});
  EXPECT_FALSE(queue_.sweep(sweep)->stopped) << "submitted again, it is judged again";
  end('a', kFailed);
  EXPECT_EQ(job('g').state, kHeld);
}

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
    EXPECT_THAT(test::refusal(StopRule::parse(text)), testing::HasSubstr("failed>10%")) << text;
  }
}

}  // namespace
}  // namespace shaken::server
