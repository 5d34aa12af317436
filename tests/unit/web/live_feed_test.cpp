#include "web/live_feed.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <shaken/frame_static_t.hpp>

#include "web/packed_frame.h"

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

/// A little-endian number at byte `at`.
std::uint16_t u16(const std::string& bytes, std::size_t at) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes.at(at)) |
                                    static_cast<unsigned char>(bytes.at(at + 1)) << 8);
}
std::int16_t i16(const std::string& bytes, std::size_t at) { return static_cast<std::int16_t>(u16(bytes, at)); }

client::RodFrame some_frame(std::size_t n_rods) {
  client::RodFrame frame;
  frame.time = 1.5;
  frame.cell.box = 20;
  frame.order = 0.75;
  frame.director = 0.25;
  frame.outlines = {{2, 0.4, 0.2}};
  for (std::size_t i = 0; i < n_rods; ++i) {
    frame.rods.push_back({5 + 0.001 * static_cast<double>(i), 15, std::numbers::pi / 4, -0.5});
  }
  return frame;
}

/// A frame as it is sent: the head, and the numbers that follow.
struct Sent {
  nlohmann::json head;
  std::string rods;
};

Sent sent(const client::RodFrame& frame) {
  const std::string bytes = packed(frame);
  const std::size_t size = u16(bytes, 0) | static_cast<std::size_t>(u16(bytes, 2)) << 16;
  EXPECT_EQ(size % 4, 0u) << "numbers of two bytes follow at an even place";
  return {nlohmann::json::parse(bytes.substr(4, size)), bytes.substr(4 + size)};
}

TEST(PackedFrame, HoldsRodsInTheUnitsOfTheBus) {
  const auto [head, rods] = sent(some_frame(3));
  EXPECT_EQ(head["n_rods"], 3);
  EXPECT_EQ(head["time_s"], 1.5);
  EXPECT_EQ(head["outlines"], nlohmann::json({{2, 0.4, 0.2}}));
  EXPECT_TRUE(head["walls"].is_null());
  ASSERT_EQ(rods.size(), 4u * 2 * 3);
  EXPECT_EQ(i16(rods, 0), -16384) << "x = 5 mm of 20 mm";
  EXPECT_EQ(i16(rods, 2 * 3), 16384) << "y = 15 mm";
  EXPECT_EQ(i16(rods, 2 * 6), 8192) << "an eighth of a turn";
  EXPECT_NEAR(i16(rods, 2 * 9), -16384, 1) << "n_z = -1/2";
}

TEST(PackedFrame, HeightsAreThereWhereTheyAreKnown) {
  client::RodFrame frame = some_frame(4);
  frame.cell.gap = 2;
  frame.heights = {1, 2, 0, 99};
  const auto [head, rods] = sent(frame);
  const std::size_t begin = 8 * 4;
  ASSERT_EQ(rods.size(), begin + 2 * 4);
  EXPECT_EQ(head["gap_mm"], 2);
  EXPECT_EQ(head["has_heights"], true);
  EXPECT_EQ(i16(rods, begin), 0) << "half way between the plates";
  EXPECT_NEAR(i16(rods, begin + 2), 16384, 1) << "at the lid";
  EXPECT_NEAR(i16(rods, begin + 4), -16384, 1) << "on the base";
  EXPECT_EQ(i16(rods, begin + 6), 32767) << "further than there is room for";
}

TEST(PackedFrame, RodsOfManyMessagesFollowEachOther) {
  const std::size_t n = proto::kRodsPerChunk + 10;
  const std::string rods = sent(some_frame(n)).rods;
  ASSERT_EQ(rods.size(), 8 * n);
  for (std::size_t i = 1; i < n; ++i) {
    ASSERT_GE(i16(rods, 2 * i), i16(rods, 2 * (i - 1))) << "x grows with the rod's number, " << i;
    ASSERT_EQ(i16(rods, 2 * (n + i)), 16384) << i;
  }
}

TEST(PackedFrame, SpeciesAndWallsAreThereWhereTheyAreInTheRun) {
  client::RodFrame frame = some_frame(2);
  frame.outlines.push_back({0, 0.5, 0.5});
  frame.cell.shape_of_rod = {1, 0};
  const auto walls = [&](const SideWalls& of) {
    frame.cell.walls = of;
    return sent(frame).head["walls"];
  };
  EXPECT_EQ(walls({.arena = Arena::kStadium, .size = 8, .length = 5})["length_mm"], 5);
  EXPECT_EQ(walls({.arena = Arena::kWedge, .size = 8, .inner = 0, .length = 5, .narrow = 2}),
            nlohmann::json({{"arena", "wedge"}, {"size_mm", 8}, {"inner_mm", 0}, {"length_mm", 5}, {"narrow_mm", 2}}));
  EXPECT_EQ(walls({.arena = Arena::kAnnulus, .size = 18, .inner = 6}),
            nlohmann::json({{"arena", "annulus"}, {"size_mm", 18}, {"inner_mm", 6}}));
  EXPECT_EQ(sent(frame).rods.substr(16), std::string("\x01\x00", 2));
  EXPECT_EQ(sent(frame).head["species_of_outline"], nlohmann::json::array());
  frame.cell.species_of_shape = {0, 0};
  EXPECT_EQ(sent(frame).head["species_of_outline"], nlohmann::json({0, 0}));
}

TEST(PackedFrame, PostsAreThereWhereTheyAreInTheRun) {
  client::RodFrame frame = some_frame(1);
  EXPECT_TRUE(sent(frame).head["posts"].is_null());
  frame.cell.posts = {.diameter = 3, .centres = {{1, 2}, {5, 6}}};
  EXPECT_EQ(sent(frame).head["posts"],
            nlohmann::json({{"diameter_mm", 3.0}, {"centres_mm", {{1.0, 2.0}, {5.0, 6.0}}}}));
  frame.cell.posts.centres.resize(10'000, Vec2(1, 2));
  EXPECT_EQ(sent(frame).head["posts"]["centres_mm"].size(), 10'000u) << "a head of more bytes than two can count";
}

}  // namespace live_feed_test
}  // namespace shaken::web
