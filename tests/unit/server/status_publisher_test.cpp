// What the publisher sends, read back from an LCM log file.
#include "server/status_publisher.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <algorithm>
#include <map>
#include <shaken/job_t.hpp>
#include <shaken/status_t.hpp>

#include "base/clock.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

struct Recording {
  std::vector<shaken::status_t> statuses;
  std::vector<shaken::job_t> jobs;
};

Recording read_log(const std::filesystem::path& file) {
  Recording recording;
  lcm_eventlog_t* log = lcm_eventlog_create(file.c_str(), "r");
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log)) {
    const std::string channel(event->channel, static_cast<std::size_t>(event->channellen));
    const std::span payload(static_cast<const std::uint8_t*>(event->data), static_cast<std::size_t>(event->datalen));
    if (channel == proto::kStatusChannel) recording.statuses.push_back(*proto::decode<shaken::status_t>(payload));
    if (channel == proto::kJobChannel) recording.jobs.push_back(*proto::decode<shaken::job_t>(payload));
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_destroy(log);
  return recording;
}

constexpr std::chrono::milliseconds kPeriod{50};

class PublisherTest : public testing::Test {
 protected:
  void start() {
    auto opened = proto::Bus::open("file://" + (directory_ / "log").string() + "?mode=w");
    ASSERT_TRUE(opened) << opened.error().message;
    DaemonInfo info;
    info.version = "1.2.3";
    info.host = "here";
    info.pid = 42;
    info.root = directory_.path();
    info.slots = 3;
    publisher_.emplace(queue_, std::move(opened).value(), info, kPeriod);
  }
  Recording stop() {
    publisher_.reset();
    return read_log(directory_ / "log");
  }

  ScratchFolder directory_;
  Queue queue_{directory_ / "queue.db"};
  std::optional<StatusPublisher> publisher_;
  const std::string a_ = std::string(16, 'a');
};

TEST_F(PublisherTest, EveryChangeOfStateIsSent) {
  start();
  queue_.submit("s", 0, std::vector{new_job('a', "rods.length=2.5")});
  begin(queue_, a_);
  queue_.ended(a_, JobEvent::kWorkerFailed, "exit 1: why");
  const Recording recording = stop();
  std::vector<std::string> states;
  std::int64_t sequence = 0;
  for (const auto& message : recording.jobs) {
    EXPECT_EQ(message.sequence, sequence++);
    EXPECT_EQ(message.job_id, a_);
    EXPECT_EQ(message.sweep_id, "s1");
    EXPECT_EQ(message.label, "rods.length=2.5");
    if (states.empty() || states.back() != message.state) states.push_back(message.state);
  }
  EXPECT_EQ(states, (std::vector<std::string>{"queued", "running", "failed"}));
  EXPECT_EQ(recording.jobs.back().reason, "exit 1: why");
  EXPECT_EQ(recording.jobs.back().attempt, 1);
}

// What runs is sent again each period, but never ahead of the changes that brought it there, nor after its end.
TEST_F(PublisherTest, NoJobIsSentAheadOfItsChanges) {
  start();
  const auto until = std::chrono::steady_clock::now() + 10 * kPeriod;
  for (int n = 0; std::chrono::steady_clock::now() < until; ++n) {
    NewJob job = new_job('a');
    job.id = fmt::format("{:016x}", n);
    queue_.submit("s", 0, std::vector{job});
    begin(queue_, job.id);
    queue_.ended(job.id, JobEvent::kWorkerDone);
  }
  const std::vector<std::string> order{"queued", "running", "done"};
  std::map<std::string, std::ptrdiff_t> reached;
  for (const auto& message : stop().jobs) {
    const auto place = std::find(order.begin(), order.end(), message.state) - order.begin();
    std::ptrdiff_t& last = reached.try_emplace(message.job_id, -1).first->second;
    EXPECT_TRUE(place == last || place == last + 1) << message.job_id << " is " << message.state;
    last = place;
  }
  EXPECT_GT(reached.size(), 10);
}

TEST_F(PublisherTest, ARunningJobIsSentAgainAndAgainWithItsProgress) {
  queue_.submit("s", 0, std::vector{new_job('a')});
  begin(queue_, a_);
  std::filesystem::create_directories(directory_ / "runs" / a_);
  write_text(directory_ / "runs" / a_ / "progress.json",
             R"({"state": "running", "message": "", "pid": 1, "n_rods": 9, "fraction": 0.5, "sim_time_s": 1,
                 "sim_time_total_s": 2, "sim_rate": 0.1, "eta_s": 10, "order": 0.25, "order_running_mean": 0.2,
                 "max_overlap_mm": 0})");
  const std::int64_t begun = utime_now();
  start();
  std::this_thread::sleep_for(10 * kPeriod);  // LCM keeps the file's end in memory: no use to look
  const Recording recording = stop();
  EXPECT_GE(recording.statuses.size(), 2U);
  std::int64_t sequence = 0;
  for (const auto& status : recording.statuses) {
    EXPECT_EQ(status.sequence, sequence++);
    EXPECT_GE(status.utime, begun);
  }
  EXPECT_GE(recording.jobs.size(), 2U);
  for (const auto& message : recording.jobs) {
    EXPECT_GE(message.utime, begun);
    EXPECT_EQ(message.state, "running");
    EXPECT_EQ(message.progress, 0.5);
    EXPECT_EQ(message.sim_time_s, 1.0);
    EXPECT_EQ(message.sim_time_total_s, 2.0);
    EXPECT_EQ(message.sim_rate, 0.1);
    EXPECT_EQ(message.eta_s, 10.0);
  }
}

TEST_F(PublisherTest, TheHeartbeatCountsTheJobs) {
  queue_.submit("s", 0, std::vector{new_job('a'), new_job('b'), new_job('c'), new_job('d')});
  begin(queue_, a_);
  begin(queue_, std::string(16, 'b'));
  queue_.cancel(std::string(16, 'b'));  // stopping: its worker runs still
  queue_.cancel(std::string(16, 'c'));
  start();
  const Recording recording = stop();
  ASSERT_FALSE(recording.statuses.empty());
  const auto& status = recording.statuses.front();
  EXPECT_EQ(status.sequence, 0);
  EXPECT_EQ(status.host, "here");
  EXPECT_EQ(status.pid, 42);
  EXPECT_EQ(status.version, "1.2.3");
  EXPECT_EQ(status.root, directory_.path().string());
  EXPECT_EQ(status.n_slots, 3);
  EXPECT_EQ(status.n_queued, 1);
  EXPECT_EQ(status.n_running, 2);
  EXPECT_EQ(status.n_cancelled, 1);
  EXPECT_GT(status.utime, 1'600'000'000'000'000);
}

TEST_F(PublisherTest, AFloodOfChangesIsSentWithoutLoss) {
  start();
  std::vector<NewJob> jobs;
  for (int i = 0; i < 350; ++i) {
    jobs.push_back(new_job('a'));
    jobs.back().id = "job" + std::to_string(i);
  }
  queue_.submit("flood", 0, jobs);
  std::vector<std::string> ids;
  for (const auto& message : stop().jobs) ids.push_back(message.job_id);
  ASSERT_EQ(ids.size(), 350U);
  EXPECT_EQ(ids.front(), "job0");
  EXPECT_EQ(ids.back(), "job349");
}

}  // namespace
}  // namespace shaken::server
