// What holds for the table of the queue as a whole. What it says in each place, queue_model_test.cpp holds against a
// description of its own.
#include "server/queue/rules.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "base/text.h"

namespace shaken::server {
namespace {

constexpr int kPhases = static_cast<int>(JobPhase::kCancelled) + 1;
constexpr int kEvents = static_cast<int>(JobEvent::kStopRuleMet) + 1;

bool has_worker(JobPhase phase) { return shaken::has_worker(stored(phase).state); }

TEST(JobStates, AreInOrderAndOfferWhatChangesTheJob) {
  const std::map<std::string, JobEvent> events{{"cancel", JobEvent::kCancel},
                                               {"hold", JobEvent::kHold},
                                               {"resume", JobEvent::kResume},
                                               {"retry", JobEvent::kRetry}};
  for (int p = 0; p < kPhases; ++p) {
    const JobStateRow& row = row_of(stored(static_cast<JobPhase>(p)).state);
    EXPECT_EQ(job_state(row.word), stored(static_cast<JobPhase>(p)).state);
    for (const std::string& request : split(row.requests, ' '))
      EXPECT_TRUE(next_phase(static_cast<JobPhase>(p), events.at(request))) << request << " in phase " << p;
  }
}

TEST(JobWords, ASweepHasOneId) {
  EXPECT_EQ(sweep_number("s22"), 22);
  for (const char* word : {"s022", "s0", "s", "s-1", "s+1", "s 1", "s22x", "S22", "22", "s99999999999999999999"}) {
    EXPECT_EQ(sweep_number(word), std::nullopt) << word << " may be a name";
  }
}

TEST(RulesTest, ARefusalPausesAtMostSixteenTimesAsLong) {
  using std::chrono::milliseconds;
  for (const auto& [times, factor] : {std::pair{0, 1}, {1, 2}, {4, 16}, {5, 16}, {100, 16}})
    EXPECT_EQ(refusal_pause(milliseconds(60'000), times), factor * milliseconds(60'000)) << times;
}

TEST(RulesTest, EveryPhaseIsARowOfItsOwn) {
  for (int k = 0; k < kPhases; ++k) {
    const auto [state, hold, after_stop] = stored(static_cast<JobPhase>(k));
    EXPECT_EQ(server::phase_of(state, hold, after_stop), static_cast<JobPhase>(k));
  }
  EXPECT_EQ(server::phase_of(JobState::kStopping, "", ""), JobPhase::kStopToQueue) << "of the first version";
  EXPECT_FALSE(server::phase_of(JobState::kHeld, "up", ""));
}

TEST(RulesTest, AJobLosesAndGetsItsWorkerInOneWayOnly) {
  for (int p = 0; p < kPhases; ++p) {
    for (int e = 0; e < kEvents; ++e) {
      const auto phase = static_cast<JobPhase>(p);
      const auto event = static_cast<JobEvent>(e);
      const bool is_end = event >= JobEvent::kWorkerDone && event <= JobEvent::kNoRoom;
      if (is_end && !has_worker(phase)) {
        EXPECT_THROW(next_phase(phase, event), std::logic_error) << p << " " << e;
      } else if (event == JobEvent::kResultsLost && phase != JobPhase::kDone) {
        EXPECT_THROW(next_phase(phase, event), std::logic_error) << p << " " << e;
      } else {
        const auto next = next_phase(phase, event);
        EXPECT_TRUE(next || !is_end) << p << " " << e;
        if (!next) continue;
        const bool gets_one = event == JobEvent::kLaunch;
        EXPECT_EQ(has_worker(*next), (has_worker(phase) || gets_one) && !is_end) << p << " " << e;
      }
    }
  }
}

}  // namespace
}  // namespace shaken::server
