// SPDX-License-Identifier: MIT
// The terms of submissions: what waits for what, how many run at once, when a sweep is stopped.
#include "server/queue/terms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/queue/queue.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using enum JobState;
using testing::HasSubstr;

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
  std::string next() const {
    std::string digits;
    for (const Job& each : queue_.next(100)) digits += each.id.front();
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

TEST_F(TermsTest, ARunGivesWayToAnotherOfItsFullSweep) {
  submit("ab", {.at_most = 1});
  begin(queue_, id('a'));
  EXPECT_EQ(next(), "");
  EXPECT_TRUE(queue_.preempt(id('a')));
  queue_.ended(id('a'), JobEvent::kWorkerStopped, "checkpoint");
  EXPECT_EQ(next(), "ba");
}

TEST_F(TermsTest, AJobObeysTheTermsOfTheLastSweepThatAskedForIt) {
  submit("ab", {.at_most = 1}, "one");
  submit("ab", {}, "two");
  begin(queue_, id('a'));
  EXPECT_EQ(next(), "b");
  submit("ab", {.at_most = 1}, "two");
  EXPECT_EQ(next(), "") << "the same sweep again, on other terms";
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

TEST_F(TermsTest, WhatIsDoneAlreadyIsNotWaitedFor) {
  const auto first = submit("a");
  end('a', kDone);
  submit("b", {.after = {first}});
  EXPECT_EQ(next(), "b");
}

TEST_F(TermsTest, WhatComesAfterSomethingThatCameToNothingIsHeld) {
  for (const JobState end_state : {kFailed, kCancelled, kTimedOut}) {
    const ScratchFolder directory;
    Queue queue(directory / "queue.db");
    const auto first = queue.submit("one", 0, std::vector{new_job('a'), new_job('b')}).sweep;
    queue.submit("two", 0, std::vector{new_job('c')}, {.after = {first}});
    queue.submit("three", 0, std::vector{new_job('d')}, {.after = {id('c')}});
    if (end_state == kCancelled) {
      queue.cancel(id('a'));
    } else {
      begin(queue, id('a'));
      if (end_state == kFailed) queue.ended(id('a'), JobEvent::kWorkerFailed, "why");
      if (end_state == kTimedOut) queue.time_out(id('a'));
      if (end_state == kTimedOut) queue.ended(id('a'), JobEvent::kWorkerStopped, "checkpoint");
    }
    const Job held = *queue.job(id('c'));
    EXPECT_EQ(held.state, kHeld);
    EXPECT_EQ(held.phase, JobPhase::kHeldForOthers);
    EXPECT_EQ(held.reason, "it was to come after s1: 1 of 2 " + std::string(to_word(end_state)));
    EXPECT_EQ(queue.history(id('c')).back().cause, held.reason);
    EXPECT_EQ(queue.job(id('d'))->state, kQueued) << "that one may still be resumed";
    EXPECT_EQ(queue.resume(id('c')), 1);
    EXPECT_EQ(begin(queue, id('c')), 1) << "to resume is to do it all the same";
    // Where the end was there first.
    queue.submit("four", 0, std::vector{new_job('e')}, {.after = {id('a')}});
    EXPECT_EQ(queue.job(id('e'))->state, kHeld);
    EXPECT_THAT(queue.job(id('e'))->reason, HasSubstr("after aaaaaaaaaaaaaaaa: "));
  }
}

TEST_F(TermsTest, ToHoldAndResumeWhatWaitsDoesNotEndTheWaiting) {
  submit("a");
  submit("b", {.after = {id('a')}});
  queue_.hold(id('b'));
  queue_.resume(id('b'));
  EXPECT_EQ(job('b').reason, "waits for aaaaaaaaaaaaaaaa");
  queue_.hold(id('b'));
  end('a', kFailed);
  EXPECT_EQ(job('b').reason, "held on request");
  queue_.resume(id('b'));
  EXPECT_EQ(job('b').phase, JobPhase::kHeldForOthers);
  queue_.cancel(id('b'));
  submit("b");
  EXPECT_EQ(next(), "b") << "asked for anew, without a wait";
}

TEST_F(TermsTest, NothingCanWaitForItself) {
  const auto one = submit("a");
  const auto two = submit("b", {.after = {one}});
  EXPECT_THROW(submit("ca", {.after = {one}}), Conflict);
  EXPECT_THROW(submit("ca", {.after = {two}}), Conflict) << "by way of b";
  EXPECT_THROW(submit("ca", {.after = {id('b')}}), Conflict);
  EXPECT_THROW(submit("b", {.after = {two}}), Conflict) << "the same sweep again";
  EXPECT_EQ(queue_.sweeps().size(), 2U);
  EXPECT_FALSE(queue_.job(id('c')).has_value()) << "nothing has happened";
  EXPECT_EQ(next(), "a");
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

TEST_F(TermsTest, AStopRuleHoldsOnlyWhatObeysIt) {
  submit("ab", {.stop_if = *StopRule::parse("failed>0")}, "ruled");
  submit("b", {}, "free");
  end('a', kFailed);
  EXPECT_EQ(job('b').state, kQueued);
}

TEST_F(TermsTest, WhatWasHeldForAnotherGoesOnWhenThatIsTriedAgain) {
  const auto first = submit("a");
  submit("b", {.after = {first}});
  end('a', kFailed);
  EXPECT_EQ(queue_.job(id('b'))->state, kHeld);
  EXPECT_EQ(queue_.retry(id('a')), 1);
  EXPECT_EQ(queue_.job(id('b'))->state, kQueued);
  EXPECT_EQ(next(), "a") << "it waits as before";
  end('a', kDone);
  EXPECT_EQ(next(), "b");
}

}  // namespace
}  // namespace shaken::server
