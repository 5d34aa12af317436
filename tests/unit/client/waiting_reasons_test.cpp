// SPDX-License-Identifier: MIT
#include "client/waiting_reasons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shaken::client {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

const std::string kRefused = "could not be started: sbatch: error: invalid partition. Next attempt at ";

std::vector<Json> jobs(int n, const std::string& state, const std::string& reason) {
  return std::vector<Json>(static_cast<std::size_t>(n),
                           Json{{"state", state}, {"ended", state == "failed"}, {"reason", reason}});
}

TEST(WaitingReasons, TellsEachOnceWhenItStands) {
  WaitingReasons reasons;
  const WaitingReasons::Clock::time_point start{};
  EXPECT_THAT(reasons.news(jobs(3, "queued", kRefused + "12:01"), start), IsEmpty()) << "it may be on its way";
  EXPECT_THAT(reasons.news(jobs(3, "queued", kRefused + "12:01"), start + seconds(3)),
              ElementsAre("3 jobs queued: " + kRefused + "12:01"));
  EXPECT_THAT(reasons.news({}, start + seconds(60)), IsEmpty());
  EXPECT_THAT(reasons.news(jobs(3, "queued", kRefused + "12:03"), start + seconds(62)), IsEmpty()) << "tried meanwhile";
  EXPECT_THAT(reasons.news(jobs(2, "queued", kRefused + "13:00"), start + seconds(200)), IsEmpty());
  EXPECT_THAT(reasons.news(jobs(2, "queued", kRefused + "13:00"), start + seconds(204)),
              ElementsAre("2 jobs queued: " + kRefused + "13:00"));
}

TEST(WaitingReasons, GroupsByWhatIsTheSameButForItsNumbers) {
  WaitingReasons reasons;
  std::vector<Json> all = jobs(1, "running", "waits as Slurm job 7_0 (Priority)");
  all.push_back(jobs(1, "running", "waits as Slurm job 7_11 (Priority)").front());
  all.push_back(jobs(1, "held", "held on request").front());
  all.push_back(jobs(1, "queued", "waits for s1: 3 of 4 done").front());
  all.push_back(jobs(1, "running", "").front());
  all.push_back(jobs(1, "failed", "exit 1").front());
  const WaitingReasons::Clock::time_point start{};
  reasons.news(all, start);
  EXPECT_THAT(reasons.news(all, start + seconds(5)),
              ElementsAre("2 jobs handed over: waits as Slurm job 7_0 (Priority)", "1 job held: held on request",
                          "1 job queued: waits for s1: 3 of 4 done"));
}

}  // namespace
}  // namespace shaken::client
