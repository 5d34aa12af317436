// Tables of tracked rods: what trackers write is read as it was meant, and what cannot be known is said.
#include "run/recorded/track_table.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "base/text.h"
#include "run/files/done.h"
#include "run/recorded/measure_command.h"
#include "run/recorded/measure_frames.h"
#include "sim/snapshot.h"
#include "tests/support/good.h"

namespace shaken::run {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;

constexpr double kInterval = 0.02;

scene::RunPlan dish() {
  scene::RunPlan plan;
  plan.system.box_side = 20;
  plan.order = scene::MeasureOrder{kInterval};
  plan.msd.emplace().every = kInterval;
  return plan;
}

TrackConventions at_intervals() {
  TrackConventions conventions;
  conventions.interval = kInterval;
  return conventions;
}

TrackedRods tracks_in(const std::string& text, const TrackConventions& conventions = at_intervals(),
                      const scene::RunPlan& plan = dish()) {
  std::vector<keys::Problem> problems;
  auto tracks = read_tracks(text, "tracks.csv", plan, conventions, problems);
  if (!tracks) throw std::runtime_error(keys::to_string(problems));
  return *std::move(tracks);
}

std::string refusal_of(const std::string& text, const TrackConventions& conventions = at_intervals(),
                       const scene::RunPlan& plan = dish()) {
  std::vector<keys::Problem> problems;
  EXPECT_FALSE(read_tracks(text, "tracks.csv", plan, conventions, problems));
  return keys::to_string(problems);
}

Snapshot frame_of(const TrackedRods& tracks, std::size_t index) {
  return *decode(*tracks.frames->frame(index), tracks.frames->header().cell.box, true);
}

void expect_rod(const Snapshot& frame, std::size_t rod, const Vec2& position, double degrees) {
  EXPECT_NEAR(frame.position[rod].x(), position.x(), 1e-5);
  EXPECT_NEAR(frame.position[rod].y(), position.y(), 1e-5);
  const double angle = degrees * kPi / 180;
  EXPECT_NEAR((frame.director[rod] - Vec3(std::cos(angle), std::sin(angle), 0)).norm(), 0, 1e-6) << degrees;
}

TEST(TrackTable, OfTrackpyIsReadInAnyOrderOfItsRows) {
  const TrackedRods tracks = tracks_in(
      ",frame,particle,y,x,angle\n"
      "0,1,7,6,5,30\n"
      "1,0,9,2,1,90\n"
      "2,0,7,4,3,60\n"
      "3,1,9,2.5,1.5,-45\n");
  ASSERT_EQ(tracks.frames->n_frames(), 2U);
  EXPECT_EQ(tracks.plan.system.n_rods, 2);
  expect_rod(frame_of(tracks, 0), 0, {3, 4}, 60);
  expect_rod(frame_of(tracks, 0), 1, {1, 2}, 90);
  expect_rod(frame_of(tracks, 1), 0, {5, 6}, 30);
  expect_rod(frame_of(tracks, 1), 1, {1.5, 2.5}, -45);
  EXPECT_DOUBLE_EQ(frame_of(tracks, 1).time, kInterval);
  EXPECT_THAT(tracks.lacking, ElementsAre(Needs::kImpacts, Needs::kSpins, Needs::kTilts, Needs::kHeads));
  EXPECT_THAT(tracks.remarks,
              ElementsAre("velocities are displacements from the frame before to the one after, over 0.02 s"));
}

TEST(TrackTable, OfOtherProgramsFormsIsReadAsTheirTablesOfRodsAre) {
  const auto as_savetxt = "# of the camera\n# frame id x y angle\n0 1 2.5 3 30\n1 1 2.5 4 30\n";  // numpy
  const auto as_excel = "sep=;\r\nframe;id;x;y;angle\r\n0;1;2,5;3;30\r\n1;1;2,5;4;30\r\n";
  const auto as_r = "\"frame\" \"id\" \"x\" \"y\" \"angle\"\n\"1\" 0 1 2.5 3 30\n\"2\" 1 1 2.5 4 30\n";
  const auto of_old_macs = "frame,id,x,y,angle\r0,1,2.5,3,30\r1,1,2.5,4,30\r";
  for (const char* text : {as_savetxt, as_excel, as_r, of_old_macs}) {
    const TrackedRods tracks = tracks_in(text);
    ASSERT_EQ(tracks.frames->n_frames(), 2U) << text;
    expect_rod(frame_of(tracks, 1), 0, {2.5, 4}, 30);
  }
  TrackConventions by_place = at_intervals();
  by_place.columns = {{"frame", "0"}, {"id", "1"}, {"x", "2"}, {"y", "3"}, {"angle", "4"}};
  expect_rod(frame_of(tracks_in("0,1,2,3,4\n0,1,2.5,3,30\n1,1,2.5,4,30\n", by_place), 1), 0, {2.5, 4}, 30);
  EXPECT_THAT(refusal_of("\xff\xfe"
                         "f\0r"),
              HasSubstr("the file is UTF-16: save it as UTF-8"));
  EXPECT_THAT(refusal_of("0,1,2,3,30\n"),
              HasSubstr("tracks.csv:1:1: the first line has numbers where the names of the columns"));
}

TEST(TrackTable, OfTrackMateHasThreeMoreTitlesAndRadians) {
  TrackConventions conventions;
  conventions.scale = 0.1;
  conventions.flips_y = true;
  const TrackedRods tracks = tracks_in(
      "LABEL,TRACK_ID,POSITION_X,POSITION_Y,POSITION_T,FRAME,ELLIPSE_THETA\n"
      "Label,Track ID,X,Y,T,Frame,Ellipse angle\n"
      "Label,Track ID,X,Y,T,Frame,El. angle\n"
      ",,(pixel),(pixel),(sec),,(radians)\n"
      "ID1,0,30,40,0.00,0,0.5\n"
      "ID2,0,50,60,0.04,1,-0.25\n",
      conventions);
  ASSERT_EQ(tracks.frames->n_frames(), 2U);
  expect_rod(frame_of(tracks, 0), 0, {3, 16}, -0.5 * 180 / kPi);
  expect_rod(frame_of(tracks, 1), 0, {5, 14}, 0.25 * 180 / kPi);
  EXPECT_NEAR(frame_of(tracks, 1).time, 0.04, 1e-12) << "times of the table";
}

TEST(TrackTable, SpotsThatAreInNoTrackAreRodsOfTheirFrame) {
  const TrackedRods tracks = tracks_in(
      "TRACK_ID,FRAME,POSITION_X,POSITION_Y,ELLIPSE_THETA\n0,0,1,2,0.5\n,0,5,6,0.5\n,0,7,6,0.5\n0,1,1,2,0.5\n");
  EXPECT_EQ(frame_of(tracks, 0).n_rods(), 3U);
  EXPECT_EQ(frame_of(tracks, 1).n_rods(), 1U);
  EXPECT_TRUE(tracks.lacking.contains(Needs::kEveryRod));
}

TEST(TrackTable, TimesAreTakenAsTheyAreWhereFramesHaveNoNumbers) {
  const TrackedRods tracks = tracks_in("t,x,y,angle\n1.5,1,2,90\n1.75,1,2,90\n");
  EXPECT_NEAR(frame_of(tracks, 1).time, 0.25, 1e-12);
}

TEST(TrackTable, OfImageJCountsDownwardsButItsAnglesAreSeenAsTheyAre) {
  TrackConventions conventions = at_intervals();
  conventions.flips_y = true;
  const TrackedRods tracks =
      tracks_in(" \tX\tY\tMajor\tAngle\tSlice\n1\t3\t4\t9\t120\t1\n2\t3\t4\t9\t121\t2\n", conventions);
  expect_rod(frame_of(tracks, 0), 0, {3, 16}, 120);
  EXPECT_THAT(tracks.lacking, IsSupersetOf({Needs::kIdentities})) << "no column tells which rod is which";
}

TEST(TrackTable, OfOtherNamesIsReadByThese) {
  TrackConventions conventions = at_intervals();
  conventions.columns = {{"x", "cx"}, {"y", "cy"}, {"angle", "phi"}, {"frame", "n"}, {"id", "rod"}};
  conventions.radians = true;
  const TrackedRods tracks = tracks_in("n;rod;cx;cy;phi\n0;1;2,5;3;1\n", conventions);
  expect_rod(frame_of(tracks, 0), 0, {2.5, 3}, 180 / kPi);
  EXPECT_THAT(refusal_of("n,rod,cx,cy,psi\n", conventions),
              HasSubstr("there is no column 'phi', which --columns names"));
  conventions.columns = {{"phi", "angle"}};
  EXPECT_THAT(refusal_of("frame,x,y,angle\n0,1,2,3\n", conventions),
              HasSubstr("--columns phi=angle: a table has frame, t, id, x, y, z, angle, tilt, nx, ny, nz, species"));
  EXPECT_THAT(refusal_of("a,b\n"),
              HasSubstr("no column is x, or y, or angle, or frame: name them by --columns x=NAME,y=NAME"));
  EXPECT_THAT(refusal_of("frame,x,X,y,angle\n"), HasSubstr("x and X are both x"));
}

TEST(TrackTable, TheCommandTakesOtherNamesToo) {
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  ASSERT_TRUE(write_file(file("t.csv"), "frame,id,x,y,phi\n0,1,2,3,1\n1,1,2,3,1\n"));
  ASSERT_TRUE(write_file(file("s.json"), R"({"box": {"side": 20}, "measure": {"order": {"every": "20 ms"}}})"));
  std::vector<std::string> words{"measure", file("t.csv"), "--scene",   file("s.json"), "--interval",
                                 "20ms",    "--columns",   "angle=phi", "--out",        file("out")};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  EXPECT_EQ(measure_command(static_cast<int>(arguments.size()), arguments.data()), 0);
  EXPECT_TRUE(is_done(RunDirectory{folder / "out"}));
}

/// Three rods in four frames; rod 2 is not seen in frame 1.
const std::string kHoles =
    "frame,id,x,y,angle\n"
    "0,1,1,1,0\n0,2,5,5,90\n0,3,9,9,0\n"
    "1,1,2,1,0\n1,2,nan,5,90\n1,3,9,9,0\n"
    "2,1,3,1,0\n2,2,5,5,90\n2,3,9,9,0\n"
    "3,1,4,1,0\n3,2,5,5,90\n3,3,9,9,0\n";

/// What is measured of tracks, after what their own scene asks for and they can tell.
Reduction measured(const TrackedRods& tracks) {
  const std::string& own = tracks.frames->header().scene_json;
  const auto made =
      test::good(plan_for_frames({own, "dish"}, {own, "dish"}, {}, *frame_spacing(*tracks.frames), tracks.lacking));
  EXPECT_EQ(made->plan.msd.has_value(), !tracks.lacking.contains(Needs::kIdentities));
  return test::good(measure_frames(made->plan, *tracks.frames))->reduction;
}

TEST(TrackTable, WithHolesIsFollowedAcrossThem) {
  const TrackedRods tracks = tracks_in(kHoles);
  EXPECT_FALSE(tracks.lacking.contains(Needs::kIdentities));
  EXPECT_TRUE(tracks.lacking.contains(Needs::kEveryRod));
  EXPECT_THAT(tracks.remarks,
              ElementsAre("2 of 3 tracks are in every frame: lags are of the rods that are in both frames; --complete "
                          "measures these alone, and --fill N closes gaps of up to N frames before",
                          "1 row without a position, an angle or a time", "2 to 3 rods in a frame, 3 on average"));
  EXPECT_THAT(frame_of(tracks, 1).track, ElementsAre(0, 2));
  const auto arrays = measured(tracks).arrays;
  using testing::DoubleNear;
  EXPECT_THAT(arrays.at("/order/order"), ElementsAre(DoubleNear(1.0 / 3, 1e-6), DoubleNear(1, 1e-6),
                                                     DoubleNear(1.0 / 3, 1e-6), DoubleNear(1.0 / 3, 1e-6)));
  // rod 1 moves by 1 mm a frame, and the others stand; rod 2 is missed in frame 1
  EXPECT_THAT(arrays.at("/msd/total_mm2"),
              ElementsAre(DoubleNear(3.0 / 7, 1e-5), DoubleNear(8.0 / 5, 1e-5), DoubleNear(9.0 / 3, 1e-5)));
}

TEST(TrackTable, RodsThatLeaveAndEnterAreRodsOfTheirOwn) {
  const TrackedRods tracks = tracks_in(
      "frame,id,x,y,angle\n0,7,1,1,0\n0,8,19,5,0\n1,7,2,1,0\n1,8,19.5,5,0\n2,7,3,1,0\n3,7,4,1,0\n2,9,9,9,0\n3,9,9,9,"
      "0\n");
  EXPECT_EQ(tracks.frames->header().n_rods, 3);
  EXPECT_EQ(tracks.plan.system.n_rods, 2) << "in a frame";
  // one-frame lags: rod 7 three times 1 mm, rod 8 once 0.5 mm, rod 9 once nothing
  EXPECT_THAT(measured(tracks).arrays.at("/msd/total_mm2").at(0), testing::DoubleNear(3.25 / 5, 1e-5));
}

TEST(TrackTable, PathsGoOnPastTheBorderAcrossAHole) {
  const TrackedRods tracks =
      tracks_in("frame,id,x,y,angle\n0,1,19,1,0\n2,1,0.5,1,0\n0,2,5,5,0\n1,2,5,5,0\n2,2,5,5,0\n");
  EXPECT_EQ(frame_of(tracks, 2).image[0], (std::array<std::int32_t, 2>{1, 0}));
  EXPECT_THAT(measured(tracks).arrays.at("/msd/total_mm2").at(1), testing::DoubleNear(1.5 * 1.5 / 2, 1e-4));
}

TEST(TrackTable, RowsWithoutATimeSayNothingOfTheirFrame) {
  for (const char* missed : {"1,nan,1,5,5,0\n", "nan,0.9,1,5,5,0\n"}) {
    const TrackedRods tracks = tracks_in(std::string("frame,t,id,x,y,angle\n") + missed +
                                         "0,0.5,2,9,9,0\n1,0.52,2,9,9,0\n2,0.54,2,9,9,0\n2,0.54,1,5,5,0\n");
    for (const std::size_t k : {1, 2})
      EXPECT_NEAR(frame_of(tracks, k).time - frame_of(tracks, k - 1).time, 0.02, 1e-9) << missed;
    EXPECT_THAT(tracks.remarks, testing::Contains("1 row without a position, an angle or a time"));
  }
}

TEST(TrackTable, CompleteTracksAreFollowed) {
  TrackConventions conventions = at_intervals();
  conventions.only_complete = true;
  const TrackedRods tracks = tracks_in(kHoles, conventions);
  EXPECT_EQ(tracks.plan.system.n_rods, 2);
  EXPECT_FALSE(tracks.lacking.contains(Needs::kIdentities));
  EXPECT_THAT(tracks.remarks[0], "2 of 3 tracks are in every frame: the others are left out");
  // one of two rods moves by 1 mm a frame
  EXPECT_THAT(measured(tracks).arrays.at("/msd/total_mm2").at(0), testing::DoubleNear(0.5, 1e-5));
}

TEST(TrackTable, GapsAreFilledStraightOnByTheShorterWay) {
  TrackConventions conventions = at_intervals();
  conventions.filled = 2;
  const std::string text =
      "frame,id,x,y,angle\n0,2,5,5,0\n1,2,5,5,0\n2,2,5,5,0\n3,2,5,5,0\n0,1,18.5,4,10\n3,1,1.5,7,-140\n";
  const TrackedRods tracks = tracks_in(text, conventions);
  EXPECT_FALSE(tracks.lacking.contains(Needs::kIdentities));
  EXPECT_THAT(tracks.remarks[0], "2 sightings interpolated, over 2 frames at most");
  expect_rod(frame_of(tracks, 1), 0, {19.5, 5}, 20);  // as an axis, it turns from 10 to 40 degrees
  expect_rod(frame_of(tracks, 2), 0, {0.5, 6}, 30);
  EXPECT_EQ(frame_of(tracks, 2).image[0], (std::array<std::int32_t, 2>{1, 0}));
  conventions.filled = 1;
  EXPECT_TRUE(tracks_in(text, conventions).lacking.contains(Needs::kEveryRod)) << "the gap is longer";
  scene::RunPlan walled = dish();
  walled.system.walls = SideWalls{.size = 19};
  const TrackedRods inside = tracks_in("frame,id,x,y,angle\n0,1,8,9,0\n1,2,9,5,0\n2,1,11,9,0\n", conventions, walled);
  expect_rod(frame_of(inside, 1), 0, {10, 9.5}, 0);  // the arena's middle is that of the box
}

TEST(TrackTable, RodsThatCrossThePeriodicBorderGoOn) {
  const std::string text = "frame,id,x,y,angle\n0,1,19.5,1,0\n1,1,0.5,1,0\n2,1,19,19.8,0\n";
  const TrackedRods tracks = tracks_in(text);
  EXPECT_EQ(frame_of(tracks, 1).image[0], (std::array<std::int32_t, 2>{1, 0}));
  EXPECT_EQ(frame_of(tracks, 2).image[0], (std::array<std::int32_t, 2>{0, -1}));

  TrackConventions wrapping = at_intervals();
  wrapping.wraps = true;
  const TrackedRods far = tracks_in("frame,id,x,y,angle\n0,1,45,-1,0\n", wrapping);
  expect_rod(frame_of(far, 0), 0, {5, 19}, 0);
  EXPECT_EQ(frame_of(far, 0).image[0], (std::array<std::int32_t, 2>{2, -1}));

  EXPECT_THAT(
      refusal_of("frame,id,x,y,angle\n0,1,45,-1,0\n"),
      HasSubstr("tracks.csv:2:1: x = 45 mm is outside of the box, which is 20 mm long: see --scale and --wrap\n"));
  EXPECT_EQ(refusal_of("frame,id,x,y,angle\n0,1,45,1,0\n1,1,46,1,0\n2,1,47,1,0\n"),
            "tracks.csv:2:1: x = 45 mm is outside of the box, which is 20 mm long: see --scale and --wrap (and 2 rows "
            "more)\n");
  scene::RunPlan walled = dish();
  walled.system.walls.emplace().arena = Arena::kSquare;
  walled.system.walls->size = 20;
  walled.system.box_side = 22;  // in the middle of which the arena lies
  EXPECT_THAT(refusal_of("frame,id,x,y,angle\n0,1,45,1,0\n", wrapping, walled),
              HasSubstr("is outside of the arena, which is 20 mm long: see --scale\n"))
      << "walls are no periodic border";
  const TrackedRods inside = tracks_in(text, at_intervals(), walled);
  EXPECT_THAT(inside.remarks, testing::Contains(HasSubstr("2 steps from a frame to the next, farther than a rod is")));
  EXPECT_THAT(tracks.remarks, testing::Not(testing::Contains(HasSubstr("farther than a rod"))));
  EXPECT_EQ(frame_of(inside, 1).image[0], (std::array<std::int32_t, 2>{0, 0}));
  expect_rod(frame_of(inside, 0), 0, {20.5, 2}, 0);
}

TEST(TrackTable, SaysWhatIsWrongWithItsLines) {
  EXPECT_THAT(refusal_of(""), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal_of("frame,x,y,angle\n"), HasSubstr("the table has no rods"));
  EXPECT_THAT(refusal_of("frame,x,y,angle\n0,a,2,3\n0,1,2\n"),
              testing::AllOf(HasSubstr("tracks.csv:2:3: x: 'a' is not a number"),
                             HasSubstr("tracks.csv:3:1: 3 fields for 4 columns")));
  EXPECT_THAT(refusal_of("frame,id,x,y,angle\n0,1,1,2,3\n0,1,1,2,3\n"), HasSubstr("rod 1 is twice in frame 0"));
  EXPECT_THAT(refusal_of("frame,x,y,angle\n0,1,2,3\n", {}), HasSubstr("--interval says the time"));
  EXPECT_THAT(refusal_of("frame,x,y,angle\n0,1,2,3\n1,1,2,3\n3,1,2,3\n"),
              HasSubstr("frames 0 and 1 are 0.02 s apart, where others are 0.03 s"));
}

TEST(TrackTable, VelocitiesAreDisplacementsOverTwoFramesAndPassTheBorder) {
  const TrackedRods tracks =
      tracks_in("frame,id,x,y,angle\n0,1,19,1,0\n1,1,19.5,1,120\n2,1,0.5,1.2,240\n0,2,5,5,0\n1,2,5,5,0\n2,2,5,5,0\n");
  EXPECT_FALSE(tracks.lacking.contains(Needs::kVelocities));
  EXPECT_FALSE(tracks.lacking.contains(Needs::kHeads)) << "rods point to all sides";
  const auto velocity = [&](std::size_t frame) { return frame_of(tracks, frame).velocity[0]; };
  EXPECT_NEAR((velocity(0) - Vec3(0.5, 0, 0) / kInterval).norm(), 0, 1e-3);
  EXPECT_NEAR((velocity(1) - Vec3(1.5, 0.2, 0) / (2 * kInterval)).norm(), 0, 1e-3);
  EXPECT_NEAR((velocity(2) - Vec3(1, 0.2, 0) / kInterval).norm(), 0, 1e-3);
  EXPECT_EQ(frame_of(tracks, 1).velocity[1].norm(), 0);
  EXPECT_TRUE(tracks_in("frame,id,x,y,angle\n0,1,19,1,0\n").lacking.contains(Needs::kVelocities)) << "one frame";
  EXPECT_TRUE(tracks_in(kHoles).lacking.contains(Needs::kVelocities)) << "not followed";
  EXPECT_EQ(lacking_of(tracks.frames->header().lacking), tracks.lacking) << "so that it can be measured anew";
}

TEST(TrackTable, HeadsAreNotToldByAnglesOfHalfATurn) {
  const auto are_told = [](const std::string& angles) {
    std::string text = "frame,x,y,angle\n";
    for (const std::string& angle : split(angles, ' ')) text += fmt::format("0,1,2,{}\n", angle);
    return !tracks_in(text).lacking.contains(Needs::kHeads);
  };
  EXPECT_FALSE(are_told("-90 -30 0 60 90"));
  EXPECT_FALSE(are_told("0 30 90 120 180"));
  EXPECT_TRUE(are_told("0 30 90 120 180 -20"));
  TrackConventions filling = at_intervals();
  filling.filled = 1;  // of an axis that turns from 179 to 1 degree, by way of 180
  const std::string turning = "frame,id,x,y,angle\n0,1,1,2,179\n2,1,1,2,1\n0,2,5,5,20\n1,2,5,5,30\n2,2,5,5,80\n";
  EXPECT_TRUE(tracks_in(turning, filling).lacking.contains(Needs::kHeads));
}

TEST(TrackTable, SpheresNeedNoAngleAndTellNothingOfTheHeadsOfOthers) {
  scene::RunPlan mixed = dish();
  auto& balls = mixed.system.added[0].emplace().rod;
  balls.n_beads = 1;
  balls.length = balls.mid_diameter;
  const TrackedRods tracks = tracks_in(
      "frame,id,x,y,angle,species\n0,1,1,2,10,0\n0,2,5,5,,1\n0,3,9,9,-100,1\n0,4,9,2,170,0\n", at_intervals(), mixed);
  EXPECT_EQ(tracks.plan.system.n_all_rods(), 4);
  EXPECT_TRUE(tracks.lacking.contains(Needs::kHeads));
  EXPECT_THAT(refusal_of("frame,x,y,angle,species\n0,1,2,3,0\n", at_intervals(), mixed),
              HasSubstr("the first frame has no rod of the species rods_2"));
}

TEST(TrackTable, OfTwoSpeciesIsMeasuredSpeciesBySpecies) {
  scene::RunPlan mixed = dish();
  mixed.system.added[0].emplace();
  mixed.of = scene::MeasuredSpecies::kEach;
  const std::string text =
      "frame,id,species,x,y,angle\n"
      "0,1,rods_2,1,1,0\n0,2,rods,5,5,90\n0,3,rods_2,9,9,90\n0,4,0,3,9,90\n"
      "1,3,1,9,9,0\n1,4,0,3,9,90\n1,2,0,6,5,90\n1,1,1,1,1,0\n";
  const TrackedRods tracks = tracks_in(text, at_intervals(), mixed);
  EXPECT_EQ(tracks.plan.system.n_rods, 2);
  EXPECT_EQ(tracks.plan.system.n_all_rods(), 4);
  EXPECT_THAT(tracks.frames->header().cell.shape_of_rod, ElementsAre(0, 0, 1, 1));
  expect_rod(frame_of(tracks, 0), 0, {5, 5}, 90);
  expect_rod(frame_of(tracks, 1), 0, {6, 5}, 90);
  expect_rod(frame_of(tracks, 1), 2, {1, 1}, 0);
  const auto arrays = measured(tracks).arrays;
  using testing::DoubleNear;
  EXPECT_THAT(arrays.at("/order/order"), ElementsAre(DoubleNear(1, 1e-6), DoubleNear(1, 1e-6)));
  EXPECT_THAT(arrays.at("/rods_2/order/order"), ElementsAre(DoubleNear(0, 1e-6), DoubleNear(1, 1e-6)));
  EXPECT_THAT(arrays.at("/msd/total_mm2").at(0), DoubleNear(0.5, 1e-5));
  EXPECT_THAT(arrays.at("/rods_2/msd/total_mm2").at(0), DoubleNear(0, 1e-9));

  // another number for the last rod: of a mixture, rods that are not in every frame are not followed
  std::string renamed = text;
  renamed.replace(renamed.rfind("\n1,1,1,") + 3, 1, "5");
  const TrackedRods unfollowed = tracks_in(renamed, at_intervals(), mixed);
  EXPECT_THAT(unfollowed.lacking, IsSupersetOf({Needs::kIdentities, Needs::kEveryRod}));
  EXPECT_THAT(unfollowed.remarks[0], HasSubstr("those of a mixture are not followed then"));
  EXPECT_FALSE(unfollowed.frames->header().are_followed());
  expect_rod(frame_of(unfollowed, 0), 0, {5, 5}, 90);
  EXPECT_THAT(measured(unfollowed).arrays.at("/rods_2/order/order"),
              ElementsAre(DoubleNear(0, 1e-6), DoubleNear(1, 1e-6)));

  const auto refused = [&](const std::string& table) { return refusal_of(table, at_intervals(), mixed); };
  EXPECT_THAT(refused("frame,x,y,angle\n0,1,2,3\n"),
              HasSubstr("column species is missing: the scene has rods and rods_2; --columns species=NAME says"));
  EXPECT_THAT(refused("frame,x,y,angle,species\n0,1,2,3,balls\n"),
              HasSubstr("tracks.csv:2:9: species: the scene has no 'balls'; it has rods, rods_2, counted from 0; "
                        "--species balls=NAME says which it is"));
  TrackConventions named = at_intervals();
  named.species = {{"long", "rods_2"}, {"short", "rods"}};
  const std::string by_names = "frame,id,x,y,angle,species\n0,1,1,2,3,long\n0,2,4,5,6,short\n";
  expect_rod(frame_of(tracks_in(by_names, named, mixed), 0), 1, {1, 2}, 3);
  EXPECT_THAT(refused("frame,x,y,angle,species\n0,1,2,3,0\n0,1,2,3,1\n1,1,2,3,0\n"),
              HasSubstr("frame 1 has others than the first: see --complete"));
  EXPECT_THAT(refused("frame,id,x,y,angle,species\n0,7,1,2,3,0\n1,7,1,2,3,1\n"),
              HasSubstr("rod 7 is of another species than before"));
}

TEST(TrackTable, AnglesThatMayBeRadiansGetARemark) {
  EXPECT_THAT(tracks_in("frame,x,y,angle\n0,1,2,3\n").remarks,
              ElementsAre("no angle is larger than 3: they are taken as degrees; if they are radians, give --radians"));
  EXPECT_THAT(tracks_in("frame,x,y,angle\n0,1,2,0\n").remarks, IsEmpty()) << "all lie along x";
  TrackConventions degrees = at_intervals();
  degrees.radians = false;
  EXPECT_THAT(tracks_in("frame,x,y,angle\n0,1,2,170\n", degrees).remarks, IsEmpty());
  TrackConventions radians = at_intervals();
  radians.radians = true;
  EXPECT_THAT(tracks_in("frame,x,y,angle\n0,1,2,6.2\n", radians).remarks, IsEmpty());
  EXPECT_THAT(tracks_in("frame,x,y,angle\n0,1,2,170\n", radians).remarks,
              ElementsAre("angles go up to 170: they are taken as radians; if they are degrees, give --degrees"));
}

}  // namespace
}  // namespace shaken::run
