#include "render/sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <shaken/frame_static_t.hpp>

#include "proto/bus.h"
#include "proto/cell_codec.h"
#include "proto/frame_codec.h"
#include "render/headline.h"
#include "render/view.h"
#include "run/files/directory.h"
#include "run/files/frame_log.h"
#include "run/files/recorded_frames.h"
#include "run/files/trajectory.h"
#include "tests/support/good.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

constexpr double kDegree = kPi / 180;

/// Nothing is to be measured.
PictureStyle plain() {
  PictureStyle style;
  style.mark_defects = false;
  return style;
}

TEST(TrajectorySource, ReadsARunDirectoryOrItsFile) {
  const ScratchFolder folder;
  plant_trajectory(folder.path(), 6);
  for (const auto& path : {folder.path(), folder / "trajectory.h5"}) {
    Result<TrajectorySource> source = test::good(TrajectorySource::open(path));
    EXPECT_EQ(source->n_frames(), 6u);
    const Result<RodPicture> picture = test::good(source->picture(4, plain()));
    EXPECT_DOUBLE_EQ(picture->frame.time, 0.2);
    EXPECT_DOUBLE_EQ(picture->cell.box.x(), 10);
    EXPECT_DOUBLE_EQ(picture->rod_length(), 4.5);
    EXPECT_NEAR(picture->found.director_angle, 40 * kDegree, 1e-5);
    EXPECT_NEAR(picture->found.order, 1, 1e-6);
    ASSERT_EQ(picture->n_rods(), 3u);
    EXPECT_NEAR(picture->frame.position[2].y(), 8, 1e-5);
    EXPECT_TRUE(picture->captions.history.time.empty());
  }
}

TEST(TrajectorySource, FindsTheNearestFrame) {
  const ScratchFolder folder;
  plant_trajectory(folder.path(), 6);
  const TrajectorySource source = TrajectorySource::open(folder.path()).value();
  const auto nearest = [&](double time) { return source.nearest_frame(time).value(); };
  EXPECT_EQ(nearest(-1), 0u);
  EXPECT_EQ(nearest(0), 0u);
  EXPECT_EQ(nearest(0.024), 0u);
  EXPECT_EQ(nearest(0.026), 1u);
  EXPECT_EQ(nearest(0.151), 3u);
  EXPECT_EQ(nearest(99), 5u);
}

TEST(TrajectorySource, HistoryEndsAtThePresentFrame) {
  const ScratchFolder folder;
  plant_trajectory(folder.path(), 6);
  TrajectorySource source = TrajectorySource::open(folder.path()).value();
  ASSERT_TRUE(source.read_history());
  const RodPicture picture = source.picture(3, plain()).value();
  ASSERT_EQ(picture.captions.history.time.size(), 4u);
  EXPECT_EQ(picture.captions.history.order.size(), 4u);
  EXPECT_DOUBLE_EQ(picture.captions.history.time.back(), 0.15);
  EXPECT_DOUBLE_EQ(picture.captions.history.end, 0.25);
  EXPECT_NEAR(picture.captions.history.order[1], 1, 1e-6);
}

TEST(TrajectorySource, TakesShakingAndMovieFromTheScene) {
  const ScratchFolder folder;
  plant_trajectory(folder.path(), 1,
                   R"({"plates": {"gamma": 7.0, "frequency": 200.0}, "movie": {"every": 0.1, "size": [640, 360]}})");
  TrajectorySource source = TrajectorySource::open(folder.path()).value();
  const RodPicture first = source.picture(0, plain()).value();
  EXPECT_EQ(first.captions.label, "\u2113 = 4.5 mm, \u03c6 = 0.07, N = 3, w = 1.2 mm");
  EXPECT_EQ(first.captions.subtitle, "L = 10 mm, \u0393 = 7, f = 200 Hz");
  const std::optional<scene::Movie> request = test::good(source.movie_request());
  EXPECT_DOUBLE_EQ(request->every, 0.1);
  EXPECT_EQ(request->width, 640);
  EXPECT_EQ(request->height, 360);
  for (const char* scene : {"", "no json", R"({"movie": {"size": "big"}, "plates": 3})"}) {
    std::filesystem::remove(folder / "trajectory.h5");
    plant_trajectory(folder.path(), 1, scene);
    TrajectorySource other = TrajectorySource::open(folder.path()).value();
    EXPECT_FALSE(other.movie_request()) << scene;
    EXPECT_EQ(other.picture(0, plain())->captions.subtitle, "L = 10 mm") << scene;
  }
}

TEST(TrajectorySource, BetweenTwoFramesRodsAreOnTheirStraightWay) {
  const ScratchFolder folder;
  std::vector<RodPicture> frames(2, empty_picture(10));
  frames[1].frame.time = 0.1;
  add_rod(frames[0], 9.8, 5, 0);  // across the border
  add_rod(frames[1], 0.2, 5.4, 0.4);
  add_rod(frames[0], 2, 8, 3.1);  // turns through half a turn: its head is a label
  add_rod(frames[1], 2, 8, 0.1);
  add_rod(frames[0], 5, 2, 0);  // too far a turn
  add_rod(frames[1], 5, 2, 1.5);
  plant_frames(folder.path(), frames, "");
  TrajectorySource source = TrajectorySource::open(folder.path()).value();
  PictureStyle style = plain();
  const RodPicture quarter = source.picture_at(0.025, style).value();
  EXPECT_DOUBLE_EQ(quarter.frame.time, 0.025);
  // The planted frames say nothing of the border's crossing: this rod has gone back through the box.
  EXPECT_NEAR(quarter.frame.position[0].x(), 9.8, 1e-5) << "farther than its length: not interpolated";
  EXPECT_NEAR(
      std::remainder(std::atan2(quarter.frame.director[1].y(), quarter.frame.director[1].x()) - (3.1 + 0.25 * 0.1416),
                     kPi),
      0, 2e-3);
  EXPECT_NEAR(std::atan2(quarter.frame.director[2].y(), quarter.frame.director[2].x()), 0, 1e-5)
      << "as the nearer frame has it";
  EXPECT_NEAR(std::atan2(source.picture_at(0.08, style)->frame.director[2].y(),
                         source.picture_at(0.08, style)->frame.director[2].x()),
              1.5, 1e-5);
  for (const double time : {-1.0, 0.0}) EXPECT_DOUBLE_EQ(source.picture_at(time, style)->frame.time, 0);
  EXPECT_DOUBLE_EQ(source.picture_at(7, style)->frame.time, 0.1);
  style.interpolate = false;
  EXPECT_DOUBLE_EQ(source.picture_at(0.025, style)->frame.time, 0);
}

TEST(Headlines, OfRunsSideBySideSayWhatDiffers) {
  RodPicture a = empty_picture(10), b = empty_picture(10), c = empty_picture(20);
  add_rod(a, 5, 5, 0);
  for (RodPicture* run : {&b, &c}) {
    add_rod(*run, 5, 5, 0);
    add_rod(*run, 5, 2, 0);
  }
  for (RodPicture* run : {&a, &b, &c}) {
    run->captions.settings = settings_of(*run);
    run->captions.settings.emplace_back("\u0393", "7");
  }
  name_runs({&a.captions, &b.captions});
  EXPECT_EQ(a.captions.label, "\u03c6 = 0.02, N = 1");
  EXPECT_EQ(b.captions.label, "\u03c6 = 0.05, N = 2");
  EXPECT_EQ(a.captions.subtitle, "");
  name_runs({&a.captions, &b.captions, &c.captions});
  EXPECT_EQ(c.captions.label, "\u03c6 = 0.01, N = 2, L = 20 mm");
  RodPicture twin = a;
  name_runs({&a.captions, &twin.captions});
  EXPECT_EQ(a.captions.label, "run 1");
  EXPECT_EQ(twin.captions.label, "run 2");
  name_runs({&a.captions});
  EXPECT_EQ(a.captions.label, "\u2113 = 4.5 mm, \u03c6 = 0.02, N = 1, w = 1.2 mm");
  EXPECT_EQ(a.captions.subtitle, "L = 10 mm, \u0393 = 7");
}

TEST(Interpolation, GoesAcrossTheBorderAndHitsEitherFrame) {
  const RodPicture rods = empty_picture(10);
  Snapshot before, after;
  before.box = after.box = rods.cell.box;
  before.position = {Vec3(9.8, 5, 0.6)};
  after.position = {Vec3(0.2, 4.6, 0.7)};
  before.image = {{0, 3}};
  after.image = {{1, 3}};
  before.director = after.director = {Vec3(1, 0, 0)};
  before.velocity = {Vec3(8, 0, 0)};
  after.velocity = {Vec3(0, 0, 0)};
  after.time = 1;
  const Snapshot half = between(before, after, 0.75, rods.cell);
  EXPECT_NEAR((half.position[0] - Vec3(0.1, 4.7, 0.675)).norm(), 0, 1e-12);
  EXPECT_EQ(half.image[0][0], 1);
  EXPECT_EQ(half.image[0][1], 3);
  EXPECT_NEAR(half.velocity[0].x(), 2, 1e-12);
  for (const double time : {0.0, 1.0}) {
    const Snapshot end = between(before, after, time, rods.cell);
    EXPECT_NEAR((end.position[0] - (time == 0 ? before : after).position[0]).norm(), 0, 1e-12);
  }
  // Half a turn is a flip of a label for a rod that is the same fore and aft, and a real turn for one that is not.
  after.director[0] = Vec3(-1, 0, 0);
  EXPECT_NEAR(between(before, after, 0.4, rods.cell).director[0].x(), 1, 1e-12);
  Cell polar = rods.cell;
  polar.shapes[0].radius.back() = 0.5;
  EXPECT_NEAR(between(before, after, 0.4, polar).position[0].x(), 9.8, 1e-12) << "stays as it was";
}

// The defects drawn are those that the run measured.
TEST(TrajectorySource, TakesTheDirectorFieldFromTheScene) {
  const ScratchFolder folder;
  plant_trajectory(folder.path(), 1, R"({"measure": {"defects": {"smoothing": 1.5, "grid": 0.25}}})");
  const RodPicture picture = TrajectorySource::open(folder.path())->picture(0, {}).value();
  RodPicture expected = picture;
  measure(expected, {.field = true, .smoothing = 1.5, .grid = 0.25});
  EXPECT_EQ(picture.found.field->mesh(), Vec2(0.25, 0.25));
  EXPECT_EQ(picture.found.field->q_at({5, 5}), expected.found.field->q_at({5, 5}));
}

// Such a box is as finite as any, but a rod would be drawn in it millions of times.
TEST(TrajectorySource, ABoxThatNoSceneHasIsRefusedAtOnce) {
  const ScratchFolder folder;
  const Cell cell{.box = 1e-6, .gap = 1.2, .shapes = {{{-2, 0, 2}, {0.2, 0.4, 0.2}}}};
  EXPECT_THAT(
      test::refusal(run::FrameLog::create(run::RunDirectory{folder.path()}.frames(), {0, cell, 1e-5, "{}", {}})),
      testing::HasSubstr("a box side of 1e-06 mm; a scene has 1 to 2000 mm"));
  EXPECT_FALSE(TrajectorySource::open(folder.path()));
}

// One rod goes 3 mm to the right and 1 mm down in 0.1 s, over two borders of a box of 10 mm.
TEST(TrajectorySource, DisplacementsGoOnAcrossBorders) {
  const ScratchFolder folder;
  const Cell cell{.box = 10, .gap = 1.2, .shapes = {{{-2, 0, 2}, {0.2, 0.4, 0.2}}}};
  auto log = run::FrameLog::create(run::RunDirectory{folder.path()}.frames(), {1, cell, 1e-5, "{}", {}}).value();
  for (int k = 0; k < 3; ++k) {
    Snapshot now;
    now.tick = k;
    now.time = 0.1 * k;
    now.box = 10;
    const double x = 5 + 3 * k, y = 1.5 - k;
    now.image = {{static_cast<std::int32_t>(std::floor(x / 10)), static_cast<std::int32_t>(std::floor(y / 10))}};
    now.position = {{x - 10 * now.image[0][0], y - 10 * now.image[0][1], 0.6}};
    now.director = {{1, 0, 0}};
    now.velocity = {{0, 0, 0}};
    ASSERT_TRUE(log.append(run::record(now)));
  }
  ASSERT_TRUE(log.sync());
  Result<TrajectorySource> source = test::good(TrajectorySource::open(folder.path()));
  PictureStyle style = plain();
  EXPECT_TRUE(source->picture(2, style)->frame.displacement.empty()) << "not asked for";
  for (const auto& [span, steps] : {std::pair{0.1, 1}, {0.2, 2}, {5.0, 2}}) {
    style.displacements = span;
    const Result<RodPicture> picture = test::good(source->picture(2, style));
    ASSERT_EQ(picture->frame.displacement.size(), 1u);
    EXPECT_NEAR(picture->frame.displacement[0].x(), 3 * steps, 1e-5) << span;
    EXPECT_NEAR(picture->frame.displacement[0].y(), -1 * steps, 1e-5) << span;
  }
  style.displacements = 0.01;
  EXPECT_THAT(test::refusal(source->picture(2, style)), testing::HasSubstr("recorded every 0.1 s"));
  EXPECT_TRUE(source->picture(0, style)) << "a film begins without";
}

// Of two tracked rods the first is missed in the first frame.
TEST(TrajectorySource, RodsThatAreMissedKeepTheirNumbers) {
  const ScratchFolder folder;
  const Cell cell{.box = 10, .gap = 1.2, .shapes = {{{-2, 0, 2}, {0.2, 0.4, 0.2}}}};
  std::vector<run::RecordedFrame> frames;
  for (int k = 0; k < 2; ++k) {
    Snapshot now;
    now.tick = k;
    now.time = 0.1 * k;
    now.box = 10;
    now.n_tracks = 2;
    for (std::uint32_t track = k == 0 ? 1 : 0; track < 2; ++track) {
      now.track.push_back(track);
      now.position.emplace_back(4.0 + k, 2.0 + 4 * track, 0.6);
      now.image.push_back({0, 0});
      now.director.emplace_back(1, 0, 0);
      now.velocity.emplace_back(0, 0, 0);
    }
    frames.push_back(run::record(now));
  }
  run::TrajectoryHeader header{2, cell, 0.1, "{}", {}};
  header.lacking = "velocities";
  ASSERT_TRUE(run::write_trajectory(folder / "trajectory.h5", run::FramesInMemory(header, frames)));
  Result<TrajectorySource> source = test::good(TrajectorySource::open(folder.path()));
  PictureStyle style = plain();
  style.displacements = 0.1;
  style.followed = 1;
  const Result<RodPicture> first = test::good(source->picture(0, style)),
                           second = test::good(source->picture(1, style));
  ASSERT_EQ(first->n_rods(), 1U);
  ASSERT_EQ(second->n_rods(), 2U);
  EXPECT_EQ(followed_rod(first->frame, style), 0U);
  EXPECT_EQ(followed_rod(second->frame, style), 1U);
  EXPECT_TRUE(second->frame.displacement[0].hasNaN()) << "nobody knows where it was";
  EXPECT_NEAR(second->frame.displacement[1].x(), 1, 1e-6);
  style.followed = 0;
  EXPECT_EQ(followed_rod(first->frame, style), std::nullopt);
  EXPECT_EQ(test::good(source->picture_at(0.04, style))->n_rods(), 1U) << "nothing lies between different rods";
  header.lacking.clear();
  ASSERT_TRUE(run::write_trajectory(folder / "trajectory.h5", run::FramesInMemory(header, frames)));
  EXPECT_THAT(test::refusal(test::good(TrajectorySource::open(folder.path()))->picture(0, style)),
              testing::HasSubstr("the orientation of rod 0 is not of unit length"))
      << "a simulation misses none";
}

TEST(TrajectorySource, SaysWhatIsMissing) {
  const ScratchFolder folder;
  EXPECT_THAT(test::refusal(TrajectorySource::open(folder.path())),
              testing::HasSubstr((folder / "trajectory.h5").string()));
  plant_trajectory(folder.path(), 0);
  EXPECT_THAT(test::refusal(TrajectorySource::open(folder.path())), testing::HasSubstr("no complete frame"));
}

/// A log of LCM messages, as lcm-logger would have written it: the static part and a frame of each of two jobs.
std::string record_two_jobs(const std::filesystem::path& log) {
  const auto bus = test::good(proto::Bus::open("file://" + log.string() + "?mode=w"));
  for (const std::string job : {"aaaa0001", "bbbb0002"}) {
    frame_static_t constants = proto::encode_cell(empty_picture(20).cell, 9000, "job " + job);
    constants.job_id = job;
    bus.value()->publish(proto::kFrameStaticChannel, constants);
    proto::Frame frame;
    frame.job_id = job;
    frame.sim_time_s = 2.5;
    frame.box = 20;
    const double angle = job == "aaaa0001" ? 0.1 : -0.4;
    for (int i = 0; i < 9000; ++i) {
      frame.rods.push_back(proto::make_pose(0.002 * i, 10, {std::cos(angle), std::sin(angle), 0}));
    }
    for (const frame_t& chunk : proto::encode_frame(frame)) bus.value()->publish(proto::kFrameChannel, chunk);
  }
  return "file://" + log.string() + "?mode=r&speed=0";
}

TEST(LivePicture, PutsTheFrameOfTheJobTogetherFromItsChunks) {
  const ScratchFolder folder;
  const std::string url = record_two_jobs(folder / "live.lcmlog");
  const Result<RodPicture> picture = test::good(live_picture(url, "bbbb", std::chrono::seconds(10), plain()));
  EXPECT_EQ(picture->captions.label, "job bbbb0002");
  EXPECT_DOUBLE_EQ(picture->frame.time, 2.5);
  ASSERT_EQ(picture->n_rods(), 9000u);
  EXPECT_NEAR(picture->found.director_angle, -0.4, 1e-4);
  EXPECT_NEAR(picture->frame.position[8999].x(), 17.998, 20.0 / 65536);
  EXPECT_DOUBLE_EQ(picture->rod_length(), 4.5);
}

/// A rod, a rod with a head that points down the y axis, and a sphere, in a square arena.
frame_static_t mixed_constants() {
  const Cell cell{.box = 20,
                  .gap = 1.2,
                  .walls = SideWalls{.arena = Arena::kSquare, .size = 15},
                  .shapes = {{{-1, 0, 1}, {0.2, 0.4, 0.2}}, {{-0.5, 0.7}, {0.4, 0.3}}, {{0}, {0.5}}},
                  .shape_of_rod = {0, 1, 2}};
  frame_static_t constants = proto::encode_cell(cell, 3, "");
  constants.job_id = "cccc0003";
  return constants;
}

Result<RodPicture> live(const std::filesystem::path& log, const frame_static_t& constants, double box_side = 20,
                        bool with_defects = false) {
  {
    const auto bus = test::good(proto::Bus::open("file://" + log.string() + "?mode=w"));
    bus.value()->publish(proto::kFrameStaticChannel, constants);
    proto::Frame frame;
    frame.job_id = constants.job_id;
    frame.box = box_side;
    for (const double angle : {0.3, -kPi / 2, 2.0}) {
      frame.rods.push_back(proto::make_pose(10, 10, {std::cos(angle), std::sin(angle), 0}));
    }
    for (const frame_t& chunk : proto::encode_frame(frame)) bus.value()->publish(proto::kFrameChannel, chunk);
  }
  return live_picture("file://" + log.string() + "?mode=r&speed=0", "cccc", std::chrono::seconds(10),
                      with_defects ? PictureStyle() : plain());
}

TEST(LivePicture, KnowsKindsOfRodsTheirHeadsAndTheWalls) {
  const ScratchFolder folder;
  const Result<RodPicture> picture = test::good(live(folder / "live.lcmlog", mixed_constants()));
  const Cell cell = *proto::decode_cell(mixed_constants());
  EXPECT_EQ(picture->cell, cell);
  EXPECT_NEAR(picture->found.director_angle, 0.3, 1e-4) << "of the first species alone";
  EXPECT_NEAR(picture->frame.director[1].y(), -1, 1e-6);
}

// What decode_cell() refuses, LiveRods of the client has, one by one.
TEST(LivePicture, RefusesWhatContradictsItselfOrIsTooLarge) {
  const ScratchFolder folder;
  frame_static_t bad = mixed_constants();
  bad.species_beads = {6, 1, -1};
  EXPECT_THAT(test::refusal(live(folder / "bad.lcmlog", bad)), testing::HasSubstr("contradict"));
  EXPECT_THAT(test::refusal(live(folder / "bad.lcmlog", mixed_constants(), 5e-324, true)),
              testing::HasSubstr("a scene has"));
  // Each of these is allowed, but not together.
  frame_static_t small = mixed_constants();
  small.species_beads = {1, 2, 3};
  small.bead_radius_mm.assign(6, 0.1);
  EXPECT_THAT(test::refusal(live(folder / "large.lcmlog", small, 2000, true)), testing::HasSubstr("too large"));
  EXPECT_TRUE(live(folder / "large.lcmlog", small, 2000, false));
}

TEST(LivePicture, TimesOutWithAReason) {
  EXPECT_THAT(test::refusal(live_picture("memq://", "cccc", std::chrono::milliseconds(300), plain())),
              testing::HasSubstr("no frame of job cccc"));
}

}  // namespace
}  // namespace shaken::render
