#include "client/live/live_rods.h"

#include <gtest/gtest.h>

#include <limits>

#include "proto/cell_codec.h"

namespace shaken::client {
namespace {

constexpr const char* kJob = "1f0c000000000000";

frame_static_t constants(int n_rods = 3) {
  frame_static_t message{};
  message.job_id = kJob;
  message.n_rods = n_rods;
  message.box_x_mm = message.box_y_mm = 20;
  message.gap_mm = 1.2;
  message.n_species = 1;
  message.species_beads = {3};
  message.n_beads = 3;
  message.bead_offset_mm = {-2, 0, 2};
  message.bead_radius_mm = {0.2, 0.4, 0.2};
  return message;
}

proto::Frame frame(std::int64_t sequence, int n_rods = 3) {
  proto::Frame frame;
  frame.job_id = kJob;
  frame.sequence = sequence;
  frame.utime = 1000 + sequence;
  frame.sim_time_s = 0.1 * static_cast<double>(sequence);
  frame.box = 20;
  frame.order = 0.9;
  frame.director_rad = 0.2;
  for (int i = 0; i < n_rods; ++i) frame.rods.push_back({1.0 + i, 2, 0.1, 0});
  return frame;
}

void send(LiveRods& rods, const proto::Frame& whole) {
  for (const frame_t& chunk : proto::encode_frame(whole)) rods.note(chunk);
}

TEST(LiveRods, PutsConstantsAndFramesTogether) {
  LiveRods rods;
  rods.select(kJob);
  send(rods, frame(0));
  EXPECT_EQ(rods.newest(), nullptr) << "the shape of the rods is not known yet";
  rods.note(constants());
  send(rods, frame(1));
  ASSERT_NE(rods.newest(), nullptr);
  const RodFrame& shown = *rods.newest();
  EXPECT_EQ(shown.rods.size(), 3u);
  EXPECT_DOUBLE_EQ(shown.time, 0.1);
  EXPECT_DOUBLE_EQ(shown.director, 0.2);
  ASSERT_EQ(shown.outlines.size(), 1u);
  EXPECT_DOUBLE_EQ(shown.outlines[0].half_length, 2);
  EXPECT_DOUBLE_EQ(shown.outlines[0].middle, 0.4);
  EXPECT_DOUBLE_EQ(shown.outlines[0].end, 0.2);
}

TEST(LiveRods, PostsComeByThemselvesAndStay) {
  LiveRods rods;
  rods.select(kJob);
  posts_t posts = proto::encode_posts({.diameter = 2, .centres = {Vec2(1, 2), Vec2(3, 4)}});
  posts.job_id = kJob;
  rods.note(posts);  // of what cell is not known yet
  rods.note(constants());
  send(rods, frame(0));
  EXPECT_TRUE(rods.newest()->cell.posts.centres.empty());
  rods.note(posts);
  rods.note(constants());
  send(rods, frame(1));
  EXPECT_EQ(rods.newest()->cell.posts, (StandingPosts{2, {Vec2(1, 2), Vec2(3, 4)}}));
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), -1.0, 21.0}) {  // what no scene has
    posts.x_mm[1] = wrong;
    rods.note(posts);
  }
  posts = proto::encode_posts({.diameter = 1e9, .centres = {Vec2(1, 2)}});
  posts.job_id = kJob;
  rods.note(posts);
  posts = proto::encode_posts({.diameter = 1, .centres = {Vec2(1, 2)}});
  posts.job_id = "another";
  rods.note(posts);
  send(rods, frame(2));
  EXPECT_EQ(rods.newest()->cell.posts.centres.size(), 2U);
}

TEST(LiveRods, SizesComeByThemselvesAndStay) {
  LiveRods rods;
  rods.select(kJob);
  frame_static_t two = constants();
  two.n_species = 2;
  two.species_beads = {3, 3};
  two.n_beads = 6;
  two.bead_offset_mm = {-2, 0, 2, -2.5, 0, 2.5};
  two.bead_radius_mm = {0.2, 0.4, 0.2, 0.2, 0.4, 0.2};
  two.rod_species = {0, 1, 1};
  two.n_rod_species = 3;
  sizes_t sizes = proto::encode_sizes({0, 0});
  sizes.job_id = kJob;
  rods.note(sizes);  // of what cell is not known yet
  rods.note(two);
  send(rods, frame(0));
  EXPECT_EQ(rods.newest()->cell.n_species(), 2U);
  rods.note(sizes);
  rods.note(two);
  send(rods, frame(1));
  EXPECT_EQ(rods.newest()->cell.n_species(), 1U);
  EXPECT_EQ(rods.newest()->cell.shape_of(2), 1U);
  for (const std::vector<std::uint8_t>& wrong : {std::vector<std::uint8_t>{0}, {1, 1}, {0, 2}, {0, 0, 0}}) {
    sizes = proto::encode_sizes(wrong);
    sizes.job_id = kJob;
    rods.note(sizes);
  }
  sizes = proto::encode_sizes({0, 1});
  sizes.job_id = "another";
  rods.note(sizes);
  send(rods, frame(2));
  EXPECT_EQ(rods.newest()->cell.n_species(), 1U);
}

TEST(LiveRods, SpheresHaveNoOrder) {
  LiveRods rods;
  rods.select(kJob);
  frame_static_t spheres = constants();
  spheres.species_beads = {1};
  spheres.bead_offset_mm = {0};
  spheres.bead_radius_mm = {0.4};
  spheres.n_beads = 1;
  rods.note(spheres);
  proto::Frame whole = frame(0);
  whole.order = std::numeric_limits<double>::quiet_NaN();
  whole.director_rad = 0;
  send(rods, whole);
  ASSERT_NE(rods.newest(), nullptr);
  EXPECT_FALSE(rods.newest()->cell.has_axes());
}

TEST(LiveRods, TakesFramesOfManyChunks) {
  LiveRods rods;
  rods.select(kJob);
  frame_static_t large = constants(15000);
  large.box_x_mm = large.box_y_mm = 500;
  rods.note(large);
  proto::Frame whole = frame(0, 15000);
  whole.box = 500;
  send(rods, whole);
  ASSERT_NE(rods.newest(), nullptr);
  EXPECT_EQ(rods.newest()->rods.size(), 15000u);
}

TEST(LiveRods, OneRunAtATime) {
  LiveRods rods;
  rods.select("another");
  rods.note(constants());
  send(rods, frame(0));
  EXPECT_EQ(rods.newest(), nullptr);
  rods.select(kJob);
  rods.note(constants());
  send(rods, frame(1));
  EXPECT_NE(rods.newest(), nullptr);
  rods.select(kJob);
  EXPECT_NE(rods.newest(), nullptr) << "the same again";
  rods.select("another");
  EXPECT_EQ(rods.newest(), nullptr);
}

TEST(LiveRods, WhatNoSceneHasIsRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    frame_static_t message = constants();
    change(message);
    LiveRods rods;
    rods.select(kJob);
    rods.note(message);
    send(rods, frame(0, message.n_rods));
    return rods.newest() == nullptr;
  };
  ASSERT_FALSE(refused([](frame_static_t&) {}));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.box_x_mm = 0; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.box_x_mm = kNaN; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.box_x_mm = 1e9; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.box_y_mm = 0.5; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.gap_mm = 0; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.bead_radius_mm[1] = 1e4; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.n_rods = -1; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.n_rods = 500000; })) << "twenty layers of rods";
  EXPECT_TRUE(refused([](frame_static_t& m) { m.species_beads = {}; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.species_beads = {4}; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.species_beads = {2, -1}; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.bead_offset_mm[2] = kNaN; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.bead_offset_mm[2] = 1e6; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.bead_radius_mm[0] = kNaN; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.bead_radius_mm[0] = 0; }));
  EXPECT_TRUE(refused([](frame_static_t& m) { m.rod_species = {0, 1, 2}; }));
  EXPECT_TRUE(refused([](frame_static_t& m) {
    m.arena = "disc";
    m.arena_size_mm = kNaN;
  }));
  // Two species, of which a rod names a third.
  EXPECT_TRUE(refused([](frame_static_t& m) {
    m.species_beads = {1, 2};
    m.rod_species = {0, 1, 2};
  }));
  EXPECT_FALSE(refused([](frame_static_t& m) {
    m.species_beads = {1, 2};
    m.rod_species = {0, 1, 1};
  }));
}

TEST(LiveRods, FramesThatDoNotFitAreIgnored) {
  LiveRods rods;
  rods.select(kJob);
  rods.note(constants());
  send(rods, frame(0, 4));
  proto::Frame other = frame(1);
  other.box = 30;
  send(rods, other);
  other = frame(2);
  other.director_rad = std::numeric_limits<double>::infinity();
  send(rods, other);
  other = frame(3);
  other.order = std::numeric_limits<double>::quiet_NaN();
  send(rods, other);
  EXPECT_EQ(rods.newest(), nullptr);
  send(rods, frame(4));
  EXPECT_NE(rods.newest(), nullptr);
}

}  // namespace
}  // namespace shaken::client
