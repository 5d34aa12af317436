// Live frames: quantisation, chunks, and what a viewer gets when chunks are lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "proto/codec.h"
#include "proto/frame_codec.h"

namespace shaken::proto {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSide = 83.73, kHigh = 21.4;

Frame random_frame(int n_rods, std::int64_t sequence) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(1000 * sequence + n_rods));
  std::uniform_real_distribution<double> unit(0, 1);
  Frame frame{1700000000000000 + sequence,
              sequence,
              "0123456789abcdef",
              0.1 * static_cast<double>(sequence),
              25000 * sequence,
              {kSide, kHigh},
              0.5,
              0.25,
              {}};
  for (int i = 0; i < n_rods; ++i) {
    frame.rods.push_back({kSide * unit(rng), kHigh * unit(rng), 2 * kPi * (unit(rng) - 0.5), 2 * unit(rng) - 1});
  }
  return frame;
}

double periodic_distance(double a, double b, double side) { return std::abs(std::remainder(a - b, side)); }

/// Angle between two axes with heads.
double axis_angle(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

std::optional<Frame> assemble(FrameAssembler& assembler, const std::vector<frame_t>& chunks) {
  std::optional<Frame> result;
  for (const frame_t& chunk : chunks) {
    if (auto frame = assembler.add(chunk)) result = frame;
  }
  return result;
}

TEST(FrameCodec, ErrorsStayWithinHalfAStep) {
  const Frame frame = random_frame(5000, 1);
  const auto chunks = encode_frame(frame);
  ASSERT_EQ(chunks.size(), 1U);
  const auto rods = decode_chunk(chunks[0]);
  ASSERT_EQ(rods.size(), frame.rods.size());
  constexpr double kSlack = 1 + 1e-9;
  for (std::size_t i = 0; i < rods.size(); ++i) {
    EXPECT_LE(periodic_distance(rods[i].x, frame.rods[i].x, kSide), kSlack * kSide / 131072);
    EXPECT_LE(periodic_distance(rods[i].y, frame.rods[i].y, kHigh), kSlack * kHigh / 131072);
    EXPECT_LE(std::abs(std::remainder(rods[i].theta - frame.rods[i].theta, 2 * kPi)), kSlack * kPi / 65536);
    EXPECT_LE(std::abs(rods[i].n_z - frame.rods[i].n_z), kSlack / 65534);
    EXPECT_GE(rods[i].theta, -kPi);
    EXPECT_LT(rods[i].theta, kPi);
    EXPECT_GE(rods[i].x, 0);
    EXPECT_LT(rods[i].x, kSide);
  }
}

TEST(FrameCodec, AnAngleThatRoundsToTheOtherEndOfTheCircleKeepsTheHead) {
  Frame frame = random_frame(0, 1);
  frame.rods = {{1, 1, std::nextafter(kPi, 0.0), 0.25}};
  const RodPose rod = decode_chunk(encode_frame(frame)[0])[0];
  EXPECT_EQ(rod.theta, -kPi);
  EXPECT_LT(axis_angle(rod.axis(), frame.rods[0].axis()), 1e-4);
}

TEST(FrameCodec, PlacesOnTheEdgeOfTheBoxStayThere) {
  Frame frame = random_frame(0, 1);
  frame.rods = {{0, std::nextafter(kHigh, 0.0), 0, 0}};
  const RodPose rod = decode_chunk(encode_frame(frame)[0])[0];
  EXPECT_LT(periodic_distance(rod.x, 0, kSide), 1e-12);
  EXPECT_LT(periodic_distance(rod.y, 0, kHigh), 1e-12);
}

TEST(Pose, KeepsTheAxis) {
  std::mt19937_64 rng(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    std::array<double, 3> axis{normal(rng), normal(rng), normal(rng)};
    const double norm = std::hypot(axis[0], axis[1], axis[2]);
    for (double& part : axis) part /= norm;
    const RodPose pose = make_pose(0, 0, axis);
    EXPECT_LT(axis_angle(pose.axis(), axis), 1e-7);
  }
  const RodPose down = make_pose(0, 0, {0, -1, 0});
  EXPECT_EQ(down.theta, -kPi / 2);
  EXPECT_EQ(make_pose(0, 0, {0, 1, 0}).theta, kPi / 2) << "the other way round";
  EXPECT_EQ(make_pose(0, 0, {0, 0, -1}).n_z, -1) << "head down";
}

TEST(FrameCodec, MessagesFitIntoOneDatagram) {
  for (const int n_rods : {0, 1, kRodsPerChunk, kRodsPerChunk + 1, 18000}) {
    const auto chunks = encode_frame(random_frame(n_rods, 3));
    EXPECT_EQ(chunks.size(), static_cast<std::size_t>(std::max(1, (n_rods + kRodsPerChunk - 1) / kRodsPerChunk)));
    for (const frame_t& chunk : chunks) EXPECT_LT(encode(chunk).size(), 60000U) << n_rods;
  }
}

TEST(FrameAssembler, TakesChunksInAnyOrder) {
  const Frame sent = random_frame(16000, 5);
  std::vector<frame_t> chunks = encode_frame(sent);
  ASSERT_EQ(chunks.size(), 3U);
  std::vector<int> order{0, 1, 2};
  do {
    FrameAssembler assembler(sent.job_id);
    const auto frame = assemble(assembler, {chunks[order[0]], chunks[order[1]], chunks[order[2]]});
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->rods.size(), sent.rods.size());
    EXPECT_EQ(std::pair(frame->tick, frame->sim_time_s), std::pair(sent.tick, sent.sim_time_s));
    for (std::size_t i = 0; i < sent.rods.size(); i += 997) {
      EXPECT_LT(periodic_distance(frame->rods[i].x, sent.rods[i].x, kSide), 0.001) << i;
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(FrameAssembler, DropsIncompleteFramesAndCountsThem) {
  FrameAssembler assembler("0123456789abcdef");
  EXPECT_TRUE(assemble(assembler, encode_frame(random_frame(8000, 0))));
  auto cut = encode_frame(random_frame(8000, 1));
  cut.pop_back();
  EXPECT_FALSE(assemble(assembler, cut));
  EXPECT_TRUE(assemble(assembler, encode_frame(random_frame(8000, 4))));  // 2 and 3 never came
  EXPECT_EQ(assembler.lost(), 3);
}

TEST(FrameAssembler, IgnoresWhatDoesNotBelong) {
  FrameAssembler assembler("0123456789abcdef");
  auto chunks = encode_frame(random_frame(8000, 2));
  auto other_job = chunks[0];
  other_job.job_id = "fedcba9876543210";
  EXPECT_FALSE(assembler.add(other_job));
  EXPECT_FALSE(assembler.add(chunks[0]));
  EXPECT_FALSE(assembler.add(chunks[0])) << "twice the same chunk is not two chunks";
  auto contradiction = chunks[1];
  contradiction.n_rods = 9000;
  EXPECT_FALSE(assembler.add(contradiction));
  auto late = encode_frame(random_frame(100, 1))[0];
  EXPECT_FALSE(assembler.add(late)) << "older than the frame under way";
  EXPECT_TRUE(assembler.add(chunks[1]));
  EXPECT_FALSE(assembler.add(chunks[1])) << "complete frames are given once";
}

TEST(FrameAssembler, RefusesImpossibleChunks) {
  FrameAssembler assembler("0123456789abcdef");
  const auto chunk = encode_frame(random_frame(10, 2))[0];
  const auto refuses = [&](auto&& spoil) {
    frame_t bad = chunk;
    spoil(bad);
    return !assembler.add(bad);
  };
  EXPECT_TRUE(refuses([](frame_t& c) { c.chunk = 1; }));
  EXPECT_TRUE(refuses([](frame_t& c) { c.chunk = -1; }));
  EXPECT_TRUE(refuses([](frame_t& c) { c.n_chunks = 0; }));
  EXPECT_TRUE(refuses([](frame_t& c) { c.n_chunks = kMostChunks + 1; }));
  EXPECT_TRUE(refuses([](frame_t& c) { c.first_rod = 5; }));
  EXPECT_TRUE(refuses([](frame_t& c) { c.n_rods = 11; }));
  EXPECT_TRUE(refuses([](frame_t& c) { c.x.pop_back(); }));
}

TEST(FrameAssembler, NumbersThatNoSenderReachesAreNoLosses) {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min(), kMost = std::numeric_limits<std::int64_t>::max();
  FrameAssembler assembler("0123456789abcdef");
  std::int64_t utime = 1700000000000000;
  for (const std::int64_t sequence : {std::int64_t{0}, kMost, std::int64_t{1}, kLeast, kMost, std::int64_t{2}}) {
    Frame frame = random_frame(100, 3);
    frame.sequence = sequence;
    frame.utime = ++utime;
    EXPECT_TRUE(assemble(assembler, encode_frame(frame))) << sequence;
    EXPECT_EQ(assembler.lost(), 0) << sequence;
  }
}

TEST(FrameAssembler, FollowsARunThatIsStartedAgain) {
  FrameAssembler assembler("0123456789abcdef");
  EXPECT_TRUE(assemble(assembler, encode_frame(random_frame(100, 900))));
  Frame again = random_frame(100, 0);
  again.utime = 1700000100000000;
  EXPECT_TRUE(assemble(assembler, encode_frame(again)));
  EXPECT_EQ(assembler.lost(), 0);
}

TEST(FrameAssembler, AForgedFrameDoesNotEndThePicture) {
  FrameAssembler assembler("0123456789abcdef");
  EXPECT_TRUE(assemble(assembler, encode_frame(random_frame(8000, 1))));
  Frame forged = random_frame(8000, 2);
  forged.sequence = forged.utime = std::numeric_limits<std::int64_t>::max();
  EXPECT_TRUE(assemble(assembler, encode_frame(forged)));
  int n_lacking = 0;
  for (std::int64_t sequence = 2; sequence < 20; ++sequence) {
    n_lacking += assemble(assembler, encode_frame(random_frame(8000, sequence))) ? 0 : 1;
  }
  EXPECT_EQ(n_lacking, 5) << "half a second of most runs";
  EXPECT_EQ(assembler.lost(), 0);
}

TEST(FrameAssembler, FramesThatComeLateAreNotTakenForTheSenders) {
  FrameAssembler assembler("0123456789abcdef");
  EXPECT_TRUE(assemble(assembler, encode_frame(random_frame(100, 50))));
  // One frame may come late many times over, and several once.
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(assemble(assembler, encode_frame(random_frame(100, 49))));
  for (std::int64_t sequence = 46; sequence < 49; ++sequence) {
    EXPECT_FALSE(assemble(assembler, encode_frame(random_frame(100, sequence))));
  }
  EXPECT_TRUE(assemble(assembler, encode_frame(random_frame(100, 51))));
  for (std::int64_t sequence = 46; sequence < 51; ++sequence) {
    EXPECT_FALSE(assemble(assembler, encode_frame(random_frame(100, sequence)))) << "counted anew";
  }
  EXPECT_TRUE(assemble(assembler, encode_frame(random_frame(100, 52))));
}

}  // namespace
}  // namespace shaken::proto
