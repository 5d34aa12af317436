// SPDX-License-Identifier: MIT
#include "web/live_feed.h"

#include <gtest/gtest.h>

#include <limits>
#include <shaken/frame_static_t.hpp>

namespace shaken::web {
namespace live_feed_test {

using namespace std::chrono_literals;

constexpr const char* kRun = "1f0c000000000000";

observables_t observables(double time, double order) {
  observables_t message{};
  message.job_id = kRun;
  message.sim_time_s = time;
  message.order = order;
  return message;
}

frame_static_t constants() {
  frame_static_t message{};
  message.job_id = kRun;
  message.n_rods = 2;
  message.box_x_mm = message.box_y_mm = 20;
  message.gap_mm = 1.2;
  message.n_species = 1;
  message.species_beads = {1};
  message.n_beads = 1;
  message.bead_offset_mm = {0};
  message.bead_radius_mm = {0.4};
  return message;
}

frame_t frame(std::int64_t sequence) {
  proto::Frame whole;
  whole.job_id = kRun;
  whole.sequence = sequence;
  whole.utime = 1000 + sequence;
  whole.box = 20;
  whole.rods.resize(2);
  return proto::encode_frame(whole).front();
}

TEST(LiveFeed, OnlyRunsOfTheDaemonTakeMemory) {
  LiveFeed feed(nullptr);
  feed.note(observables(1, 0.5));
  feed.keep({kRun});
  EXPECT_TRUE(feed.order(kRun).times().empty()) << "what came before is nobody's";
  feed.note(observables(2, 0.6));
  feed.note(observables(3, 0.7));
  EXPECT_EQ(feed.order(kRun).values(), (std::vector<double>{0.6, 0.7}));
  feed.keep({});
  EXPECT_TRUE(feed.order(kRun).times().empty());
}

TEST(LiveFeed, TellsEachListenerWhatIsNewToIt) {
  LiveFeed feed(nullptr);
  feed.keep({kRun});
  LiveSeen first, second;
  EXPECT_FALSE(feed.wait(kRun, first, 1ms).observables);
  feed.note(observables(1, 0.5));
  EXPECT_DOUBLE_EQ(feed.wait(kRun, first, 1ms).observables->order, 0.5);
  EXPECT_FALSE(feed.wait(kRun, first, 1ms).observables) << "it has had that";
  EXPECT_TRUE(feed.wait(kRun, second, 1ms).observables) << "the other has not";
  EXPECT_FALSE(feed.wait("ffffffffffffffff", first, 1ms).observables) << "no such run";
}

TEST(LiveFeed, RodsArePutTogetherWhileSomebodyLooks) {
  LiveFeed feed(nullptr);
  feed.keep({kRun});
  feed.note(constants());
  feed.note(frame(1));
  LiveSeen seen;
  EXPECT_EQ(feed.wait(kRun, seen, 1ms).frame, nullptr) << "nobody had asked before";
  feed.note(frame(2));
  const LiveNews news = feed.wait(kRun, seen, 1ms);
  ASSERT_NE(news.frame, nullptr);
  EXPECT_EQ(news.frame->rods.size(), 2u);
}

TEST(LiveFeed, TheNextFrameIsNoneThatCameBefore) {
  LiveFeed feed(nullptr);
  EXPECT_EQ(feed.next_frame(kRun, 1min), nullptr) << "no such run: nothing is waited for";
  feed.keep({kRun});
  feed.note(constants());
  EXPECT_EQ(feed.next_frame(kRun, 1ms), nullptr);
  feed.note(frame(1));
  EXPECT_EQ(feed.next_frame(kRun, 1ms), nullptr) << "it may be long ago";
  std::jthread later([&] {
    std::this_thread::sleep_for(50ms);
    feed.note(frame(2));
  });
  EXPECT_NE(feed.next_frame(kRun, 20s), nullptr);
}

TEST(LiveFeed, AForgedFrameDoesNotStopTheRods) {
  LiveFeed feed(nullptr);
  feed.keep({kRun});
  feed.note(constants());
  LiveSeen seen;
  feed.wait(kRun, seen, 1ms);
  frame_t forged = frame(1);
  forged.sequence = forged.utime = std::numeric_limits<std::int64_t>::max();
  feed.note(forged);
  EXPECT_NE(feed.wait(kRun, seen, 1ms).frame, nullptr);
  for (std::int64_t sequence = 2; sequence < 10; ++sequence) feed.note(frame(sequence));
  EXPECT_NE(feed.wait(kRun, seen, 1ms).frame, nullptr);
}

TEST(LiveFeed, AListenerIsWokenByWhatComes) {
  LiveFeed feed(nullptr);
  feed.keep({kRun});
  std::jthread sender([&] {
    std::this_thread::sleep_for(50ms);
    feed.note(observables(1, 0.25));
  });
  LiveSeen seen;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(feed.wait(kRun, seen, 600s).observables);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 300s) << "woken, not timed out";
}

}  // namespace live_feed_test
}  // namespace shaken::web
