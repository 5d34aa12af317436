// Rods from files: what the reader of tables takes and refuses, and where the rods are then.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/files/frame_log.h"
#include "run/files/trajectory.h"
#include "run/import/place_rods.h"
#include "run/loop/import_id.h"
#include "run/loop/open_run.h"
#include "scene/canonical.h"
#include "sim/simulation.h"
#include "tests/support/good.h"
#include "tests/support/random_rods.h"
#include "tests/support/short_rods.h"

namespace shaken::run {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<std::string> kOne{"rods"};
const std::vector<std::string> kTwo{"rods", "rods_2"};

/// Rods of a table that is right.
std::vector<ImportedRod> rods_in(const std::string& text, const std::vector<std::string>& species = kOne) {
  std::vector<keys::Problem> problems;
  std::vector<std::string> remarks;
  const auto rods = read_csv_rods(text, "rods.csv", species, problems, remarks);
  EXPECT_TRUE(problems.empty()) << keys::to_string(problems);
  return rods;
}

std::vector<std::string> lines_of(const std::vector<keys::Problem>& problems) {
  std::vector<std::string> lines;
  for (const keys::Problem& problem : problems) lines.push_back(to_string(problem));
  return lines;
}

/// What is said of one that is wrong.
std::vector<std::string> problems_in(const std::string& text, const std::vector<std::string>& species = kOne) {
  std::vector<keys::Problem> problems;
  std::vector<std::string> remarks;
  read_csv_rods(text, "rods.csv", species, problems, remarks);
  return lines_of(problems);
}

TEST(CsvRods, AreReadByTheNamesOfTheColumns) {
  const auto rods = rods_in("# tracked\n\ny, x ,nz,nx,ny,z\r\n1.5,+2,0,0.6,0.8,0.45\n\n3,4e0,1,0,0,1\n");
  ASSERT_EQ(rods.size(), 2U);
  EXPECT_EQ(rods[0].position, Vec3(2, 1.5, 0.45));
  EXPECT_NEAR((rods[0].director - Vec3(0.6, 0.8, 0)).norm(), 0, 1e-15);
  const auto rounded = rods_in("x,y,nx,ny,nz\n1,2,0.6004,0.8003,0.0\n")[0].director;
  EXPECT_NEAR(rounded.norm(), 1, 1e-15);
  EXPECT_NEAR(rounded.y() / rounded.x(), 0.8003 / 0.6004, 1e-15) << "the direction stays";
  EXPECT_EQ(rods[0].number, 4) << "the line";
  EXPECT_EQ(rods[1].number, 6);
  EXPECT_EQ(rods[1].director, Vec3(0, 0, 1));
  EXPECT_EQ(rods[1].velocity, Vec3(0, 0, 0));
  EXPECT_EQ(rods[1].angular_velocity, Vec3(0, 0, 0));
}

TEST(CsvRods, MayGiveAnglesAndLeaveOutHeights) {
  const auto rods = rods_in("\xef\xbb\xbfx,y,angle,tilt,vz,wx\n1,2,90,0,3,4\n1,2,0,-30,0,0\n1,2,-180,0,0,0");
  ASSERT_EQ(rods.size(), 3U);
  EXPECT_NEAR((rods[0].director - Vec3(0, 1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((rods[1].director - Vec3(std::sqrt(0.75), 0, -0.5)).norm(), 0, 1e-15);
  EXPECT_NEAR((rods[2].director - Vec3(-1, 0, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(rods[0].velocity, Vec3(0, 0, 3));
  EXPECT_EQ(rods[0].angular_velocity, Vec3(4, 0, 0));
  for (const ImportedRod& rod : rods) EXPECT_TRUE(std::isnan(rod.position.z()));
}

TEST(CsvRods, NameTheirSpeciesOrCountThemFromZero) {
  const auto rods = rods_in("x,y,angle,species\n1,1,0,rods_2\n1,1,0,0\n1,1,0,1\n1,1,0,rods\n", kTwo);
  std::vector<int> species;
  for (const ImportedRod& rod : rods) species.push_back(rod.shape);
  EXPECT_THAT(species, ElementsAre(1, 0, 1, 0));
}

TEST(CsvRods, ThatAreWrittenExactlyAreReadExactly) {
  test::Draw draw(7);
  std::vector<ImportedRod> written;
  std::string text = "x,y,z,nx,ny,nz,vx,vy,vz,wx,wy,wz,species\n";
  for (int i = 0; i < 300; ++i) {
    const ImportedRod rod{.number = i + 2,
                          .shape = static_cast<std::uint8_t>(draw.integer(0, 1)),
                          .position = draw.vector(std::pow(10, draw.uniform(-8, 3))),
                          .director = draw.direction(),
                          .velocity = draw.vector(100),
                          .angular_velocity = draw.vector(50)};
    for (const Vec3& v : {rod.position, rod.director, rod.velocity, rod.angular_velocity})
      text += fmt::format("{},{},{},", v.x(), v.y(), v.z());
    text += fmt::format("{}\n", rod.shape);
    written.push_back(rod);
  }
  const auto read = rods_in(text, kTwo);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].number, written[i].number);
    EXPECT_EQ(read[i].shape, written[i].shape);
    EXPECT_EQ(read[i].position, written[i].position);
    EXPECT_EQ(read[i].velocity, written[i].velocity);
    EXPECT_EQ(read[i].angular_velocity, written[i].angular_velocity);
    EXPECT_LT((read[i].director - written[i].director).norm(), 3e-16) << "normalised once more";
  }
}

// One rod at (1.5, 2.5) mm, 30 degrees from x, as it is written by ...
TEST(CsvRods, MayBeWrittenByOtherPrograms) {
  for (const char* text : {
           "x,y,angle\n1.5,2.5,30\n",                                // Excel and LibreOffice, en_US
           "\xef\xbb\xbfx;y;angle\r\n1,5;2,5;30\r\n",                // Excel, de_DE and fr_FR
           "sep=;\r\nx;y;angle\r\n1,5;2,5;30,0\r\n",                 // Excel, with its own first line
           "x,y,angle\r1.5,2.5,30\r",                                // Excel, CSV (Macintosh)
           "x,y,angle\n\"1,5\",\"2,5\",30\n",                        // Google Sheets, de_DE
           "x\ty\tangle\n1.5\t2.5\t30\n",                            // ImageJ, TrackMate
           " ,x,y,angle\n1,1.5,2.5,30\n",                            // ImageJ with the numbers of rows
           ",x,y,angle\n0,1.5,2.5,30.0\n",                           // pandas (trackpy)
           "\"\",\"x\",\"y\",\"angle\"\n\"1\",1.5,2.5,30\n",         // R, write.csv
           "\"\";\"x\";\"y\";\"angle\"\n\"1\";1,5;2,5;30\n",         // R, write.csv2
           "\"x\" \"y\" \"angle\"\n\"1\" 1.5 2.5 30\n",              // R, write.table
           "# x,y,angle\n1.500000000000000000e+00,2.5e+00,3e+01\n",  // numpy.savetxt, delimiter=","
           "# x y angle\n1.5e+00 2.5e+00 3e+01\n",                   // numpy.savetxt
           "# x,y,angle\n# tracked\n1.5 2.5 30\n",                   // the same with a header of another kind
       }) {
    const auto rods = rods_in(text);
    ASSERT_EQ(rods.size(), 1U) << text;
    EXPECT_EQ(rods[0].position.head<2>(), Vec2(1.5, 2.5)) << text;
    EXPECT_NEAR(rods[0].director.y(), 0.5, 1e-15) << text;
  }
  EXPECT_THAT(problems_in("1.5,2.5,30\n3,4,50\n"),
              ElementsAre(HasSubstr("rods.csv:1:1: the first line has numbers where the names of the columns should")));
  EXPECT_THAT(problems_in(std::string("\xff\xfex\0,\0", 6)), ElementsAre(HasSubstr("the file is UTF-16")));
  EXPECT_THAT(
      problems_in(",y,x,mass,size,ecc,frame\n"),
      ElementsAre(HasSubstr("there are no columns 'mass', 'size', 'ecc', 'frame': remove them, or name each as"),
                  HasSubstr("column angle (or nx and ny) is missing")));
  EXPECT_THAT(problems_in("x;y;angle\n1.234,5;2;30\n"), ElementsAre("rods.csv:2:1: x: '1.234,5' is not a number"));
}

TEST(CsvRods, WhoseAnglesAreSmallMayBeInRadians) {
  const auto remarks_on = [](const std::string& text) {
    std::vector<keys::Problem> problems;
    std::vector<std::string> remarks;
    read_csv_rods(text, "rods.csv", kOne, problems, remarks);
    return remarks;
  };
  EXPECT_THAT(remarks_on("x,y,angle\n1,1,1.57\n2,2,-0.3\n"), ElementsAre(HasSubstr("no angle is larger than 1.57")));
  EXPECT_THAT(remarks_on("x,y,angle\n1,1,0\n2,2,0\n"), ElementsAre());
  EXPECT_THAT(remarks_on("x,y,angle\n1,1,1.57\n2,2,90\n"), ElementsAre());
}

TEST(CsvRods, TellEverythingThatIsWrongWithTheFirstLine) {
  EXPECT_THAT(
      problems_in("x,z,nx,vy,vy,angel\n1,2,3,4,5,6\n"),
      ElementsAre(HasSubstr("rods.csv:1:11: column vy is there twice"),
                  HasSubstr("rods.csv:1:14: there is no column 'angel'; did you mean angle?"),
                  HasSubstr("rods.csv:1:1: column y is missing"), HasSubstr("rods.csv:1:1: column ny is missing")));
  EXPECT_THAT(problems_in("x,y\n"), ElementsAre(HasSubstr("column angle (or nx and ny) is missing")));
  EXPECT_THAT(problems_in("x,y,tilt\n"), ElementsAre(HasSubstr("column angle is missing")));
  EXPECT_THAT(problems_in("x,y,nx,ny,angle\n"), ElementsAre(HasSubstr("directors are given twice")));
  EXPECT_THAT(problems_in("x,y,angle\n", kTwo),
              ElementsAre(HasSubstr("rods.csv:1:1: column species is missing: the scene has rods and rods_2")));
  EXPECT_THAT(problems_in("x,y,angle,species\n0,0,0,rods_9\n", {}), ElementsAre()) << "the scene is not known";
  EXPECT_THAT(problems_in("# nothing\n"), ElementsAre(HasSubstr("rods.csv: the file is empty")));
}

TEST(CsvRods, TellEverythingThatIsWrongWithTheOthers) {
  const char* text =
      "x,y,nx,ny,species\n"
      "1,one,1,0,rods\n"
      "nan,inf,1,0,rods\n"
      "1,2,1,0\n"
      "1,2,1,0,0,\n"
      "1,2,0,0,rods\n"
      "1,2,1.002,0,rods\n"
      "1,2,1.0009,0,rods\n"
      "1,2,1,0,rods_3\n"
      "1e999,2,1,0,rods\n"
      "1 2,,1,0,rods\n";
  EXPECT_THAT(problems_in(text),
              ElementsAre("rods.csv:2:3: y: 'one' is not a number", "rods.csv:3:1: x: 'nan' is not a number",
                          "rods.csv:3:5: y: 'inf' is not a number", HasSubstr("rods.csv:4:1: 4 fields for 5 columns"),
                          HasSubstr("rods.csv:5:1: 6 fields for 5 columns"),
                          HasSubstr("rods.csv:6:5: the director has length 0, not 1"),
                          HasSubstr("rods.csv:7:5: the director has length 1.002, not 1"),
                          HasSubstr("rods.csv:9:9: species: the scene has no 'rods_3'; it has rods, counted from 0"),
                          "rods.csv:10:1: x: '1e999' is not a number", "rods.csv:11:1: x: '1 2' is not a number",
                          "rods.csv:11:5: y: '' is not a number"));
  EXPECT_THAT(problems_in("angle,tilt,x,y\n-1e7,91,1,1\n"),
              ElementsAre("rods.csv:2:1: angle: -10000000 is outside of [-1000000, 1000000] degrees",
                          "rods.csv:2:6: tilt: 91 is outside of [-90, 90] degrees"));
}

struct Placed {
  std::optional<PlacedRods> rods;
  std::vector<std::string> problems;
};
Placed placed(const System& system, const std::string& text) {
  std::vector<keys::Problem> problems;
  std::vector<std::string> remarks;
  const auto rods = read_csv_rods(text, "rods.csv", species_names(system), problems, remarks);
  auto world = place_rods(system, rods, "rods.csv", true, problems);
  return {std::move(world), lines_of(problems)};
}

TEST(PlacedRods, LieAsLowAsTheBaseAllowsWhereTheirHeightIsNotGiven) {
  const auto [rods, problems] = placed(test::short_rods(3), "x,y,angle,tilt\n2,2,0,0\n6,6,45,10\n9,12,200,-5\n");
  ASSERT_TRUE(rods) << ::testing::PrintToString(problems);
  const World& world = rods->world;
  EXPECT_EQ(rods->n_resting, 3);
  EXPECT_EQ(rods->n_still, 1) << "two are tilted";
  EXPECT_LT(rods->deepest, 1e-12);
  EXPECT_EQ(world.rods[2].position.y(), 0) << "the other side of the box is this one";
  const double base = world.plates.at(0).base;
  EXPECT_NEAR(world.rods[0].position.z(), base + 0.4, 1e-15) << "the radius of its middle";
  for (const Flight& rod : world.rods) {
    double lowest = INFINITY;
    for (int b = 0; b < world.species[0].n_beads(); ++b) {
      const double z = rod.position.z() + world.species[0].bead_offset[b] * rod.director.z();
      lowest = std::min(lowest, z - world.species[0].bead_radius[b]);
    }
    EXPECT_NEAR(lowest, base, 1e-15);
  }
}

TEST(PlacedRods, HaveTheHeightsOverTheBaseAndTheMotionThatAreGiven) {
  const auto [rods, problems] =
      placed(test::short_rods(1), "x,y,z,nx,ny,nz,vx,vy,vz,wx,wy,wz\n2,3,0.6,0.6,0.8,0,1,2,3,4,5,6\n");
  ASSERT_TRUE(rods) << ::testing::PrintToString(problems);
  EXPECT_EQ(rods->n_resting, 0);
  EXPECT_EQ(rods->n_still, 0);
  const Snapshot seen = snapshot(rods->world);
  EXPECT_EQ(seen.tick, 0);
  EXPECT_NEAR((seen.position[0] - Vec3(2, 3, 0.6 + rods->world.plates.at(0).base)).norm(), 0, 1e-15);
  EXPECT_NEAR((seen.director[0] - Vec3(0.6, 0.8, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((seen.velocity[0] - Vec3(1, 2, 3)).norm(), 0, 1e-14);
  EXPECT_NEAR((seen.angular_velocity[0] - Vec3(4, 5, 6)).norm(), 0, 1e-13);
}

TEST(PlacedRods, KeepTheirOrderWithinEachSpecies) {
  System system = test::short_rods(3);
  system.added[0] = AddedRods{.rod = {.length = 1.5, .n_beads = 5}, .count = 2};
  const auto [rods, problems] =
      placed(system, "x,y,angle,species\n1,2,0,rods_2\n1,4,0,rods\n1,6,0,rods\n1,8,0,rods_2\n1,10,0,rods\n");
  ASSERT_TRUE(rods) << ::testing::PrintToString(problems);
  std::vector<double> first, second;
  for (std::size_t i = 0; i < 5; ++i)
    (rods->world.shape_of_rod[i] == 0 ? first : second).push_back(rods->world.rods[i].position.y());
  EXPECT_THAT(first, ElementsAre(4, 6, 10));
  EXPECT_THAT(second, ElementsAre(2, 8));
}

TEST(PlacedRods, OfATableAreAlike) {
  System system = test::short_rods(2);
  system.rod.spread.length = 0.1;
  const auto [rods, problems] = placed(system, "x,y,angle\n1,4,0\n1,6,0\n");
  EXPECT_FALSE(rods);
  EXPECT_THAT(problems, ElementsAre(HasSubstr("leave out length_spread and end_diameter_spread, or import the")));
}

TEST(PlacedRods, AreRefusedWithAllThatIsWrong) {
  const auto [rods, problems] = placed(test::short_rods(7),
                                       "x,y,z,angle\n"
                                       "2,2,0.5,0\n"
                                       "2,2.7,0.5,0\n"     // 100 um in the first
                                       "6,6,0.38,0\n"      // 20 um in the base
                                       "6,8,0.85,0\n"      // 50 um in the lid
                                       "-0.1,2,0.5,0\n"    // outside
                                       "2,12.1,0.5,0\n");  // outside
  EXPECT_FALSE(rods);
  EXPECT_THAT(problems,
              ElementsAre(HasSubstr("rods.csv: the file has 6 rods of `rods` that can be read, and the scene has 7"),
                          HasSubstr("rods.csv:6:1: the centre (-0.1, 2) mm is outside of the box, [0, 12] by [0, 12]"),
                          HasSubstr("rods.csv:7:1: the centre (2, 12.1) mm is outside"),
                          "rods.csv:2:1: overlaps the rod of line 3 by 100.0 um",
                          "rods.csv:5:1: overlaps the lid by 50.0 um", "rods.csv:4:1: overlaps the base by 20.0 um",
                          HasSubstr("rods.csv: 3 overlaps deeper than 10.0 um: ")));
}

TEST(PlacedRods, MayOverlapAsHitsDo) {
  // beads of radius 0.2 at the ends: 10 um
  const auto at = [](const char* y) {
    return placed(test::short_rods(2), fmt::format("x,y,angle\n2,2,0\n2,{},0\n", y));
  };
  const auto slight = at("2.791");
  ASSERT_TRUE(slight.rods) << ::testing::PrintToString(slight.problems);
  EXPECT_NEAR(slight.rods->deepest, 0.009, 1e-12);
  EXPECT_FALSE(at("2.789").rods);
}

TEST(PlacedRods, OfWhichManyOverlapAreListedUpToTwenty) {
  std::string text = "x,y,angle\n";
  for (int i = 0; i < 8; ++i) text += fmt::format("6,{},0\n", 6 + 0.01 * i);
  const auto [rods, problems] = placed(test::short_rods(8), text);
  EXPECT_FALSE(rods);
  ASSERT_EQ(problems.size(), 21U);
  EXPECT_THAT(problems.front(), HasSubstr("by 790.0 um")) << "the deepest first";
  EXPECT_THAT(problems.back(), HasSubstr("28 overlaps deeper than 10.0 um, of which the deepest 20 are listed"));
}

// To gather all overlaps of 20,000 rods in one place would take minutes and gigabytes.
TEST(PlacedRods, InOtherUnitsAreRefusedAtOnce) {
  System system = test::short_rods(20000, 600);
  std::string metres = "x,y,angle\n", one_place = metres;
  for (int i = 0; i < 20000; ++i) {
    metres += fmt::format("{},{},0\n", 0.004 * (i % 142), 0.004 * (i / 142));
    one_place += "300,300,0\n";
  }
  EXPECT_THAT(placed(system, metres).problems, ElementsAre(HasSubstr("are these in metres?")));
  EXPECT_THAT(placed(system, one_place).problems, ElementsAre(HasSubstr("rods have their centres within 2.5 mm of")));
}

TEST(PlacedRods, WithinWallsAndAmongPostsAreHeldAgainstThese) {
  System system = test::short_rods(2, 14);
  system.walls = SideWalls{.arena = Arena::kSquare, .size = 12};
  EXPECT_THAT(placed(system, "x,y,angle\n7,7,0\n2,3,0\n").problems,
              ElementsAre("rods.csv:3:1: overlaps the side wall by 250.0 um", HasSubstr("1 overlap deeper")))
      << "a tip at 0.75 mm, and the wall at 1 mm";
  system.walls.reset();
  system.posts = Posts{.diameter = 2, .columns = 1, .rows = 1};
  EXPECT_THAT(placed(system, "x,y,angle\n9,7,0\n7,2,0\n").problems,
              ElementsAre("rods.csv:2:1: overlaps the post by 250.0 um", HasSubstr("1 overlap deeper")))
      << "a tip at 7.75 mm, and the post about 7 mm";
}

TEST(PlacedRods, WithoutPlatesLieInOnePlaneOrHaveHeights) {
  System system = test::short_rods(1);
  system.base = system.lid = false;
  EXPECT_THAT(placed(system, "x,y,angle\n2,2,0\n").problems,
              ElementsAre(HasSubstr("rods.csv:2:1: there is no base on which it could rest: give its height")));
  EXPECT_TRUE(placed(system, "x,y,z,angle\n2,2,7,0\n").rods);
  system.gravity = 0;
  const auto planar = placed(system, "x,y,angle,vx\n2,2,30,5\n");
  ASSERT_TRUE(planar.rods) << ::testing::PrintToString(planar.problems);
  const auto middle = Simulation::start(system).value().snapshot().position[0].z();
  EXPECT_EQ(planar.rods->world.rods[0].position.z(), middle) << "as at any start";
  EXPECT_EQ(planar.rods->n_resting, 0);
  for (const char* text : {"x,y,z,angle\n2,2,0.7,0\n", "x,y,angle,tilt\n2,2,0,1\n", "x,y,angle,vz\n2,2,0,1\n",
                           "x,y,angle,wx\n2,2,0,1\n"}) {
    EXPECT_THAT(placed(system, text).problems, ElementsAre(HasSubstr("all rods lie in the middle plane"))) << text;
  }
}

TEST(PlacedRods, GetTheRandomMotionOfAnyStartWhereThatIsAskedFor) {
  auto rods = test::good(placed(test::short_rods(2), "x,y,angle\n2,2,0\n2,6,0\n").rods);
  EXPECT_EQ(rods->n_still, 2);
  const World still = rods->world;
  draw_velocities(rods->world);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(rods->world.rods[i].position, still.rods[i].position);
    EXPECT_EQ(rods->world.rods[i].director, still.rods[i].director);
    EXPECT_GT(rods->world.rods[i].velocity.norm(), 1);
  }
  EXPECT_NE(rods->world.rods[0].velocity, rods->world.rods[1].velocity);
}

/// A log of a run of `system` with the frame of each tick.
class RecordedRods : public ::testing::Test {
 protected:
  std::string record_run(const System& system, const std::vector<Tick>& ticks) {
    Simulation simulation = Simulation::start(system).value();
    scene::RunPlan plan;
    plan.system = system;
    const TrajectoryHeader header =
        trajectory_header(simulation.world(), scene::to_json(plan).dump(), {scene::run_id(plan), system.seed});
    auto log = FrameLog::create(folder_ / "trajectory.part", header);
    for (const Tick tick : ticks) {
      EXPECT_FALSE(simulation.advance_to(tick));
      EXPECT_TRUE(log->append(record(simulation.snapshot())));
      snapshots_.push_back(simulation.snapshot());
      bases_.push_back(simulation.world().plates.at(tick).base);
    }
    return (folder_ / "trajectory.part").string();
  }

  ScratchFolder folder_;
  std::vector<Snapshot> snapshots_;
  std::vector<double> bases_;
};

TEST_F(RecordedRods, AreThoseOfTheFileWithTheHeightsOverTheBaseOfThen) {
  System system = test::short_rods(40);
  system.dt = 2e-5;  // 250 ticks of a vibration
  system.rod.spread.length = 0.1;
  system.added[0] = AddedRods{.rod = {.length = 1.5, .n_beads = 5}, .count = 10};
  system.start = Start::kRandom;
  system.box_side = 16;
  const std::string file = record_run(system, {0, 60, 250});
  for (const std::size_t frame : {0, 1, 2}) {
    const auto rods =
        read_recorded_rods(file, frame == 2 ? std::nullopt : std::optional(static_cast<int>(frame)), system);
    ASSERT_TRUE(rods) << rods.error().message;
    std::vector<keys::Problem> problems;
    const auto placed = place_rods(system, *rods, file, false, problems);
    ASSERT_TRUE(placed) << keys::to_string(problems);
    const RecordedFrame then = record(snapshots_[frame]), now = record(snapshot(placed->world));
    EXPECT_EQ(now.velocity, then.velocity);
    if (frame != 1) {  // whole vibrations
      EXPECT_EQ(now.position, then.position);
    }
    ASSERT_EQ(now.orientation.size(), then.orientation.size());
    for (std::size_t k = 0; k < now.orientation.size(); ++k)
      EXPECT_NEAR(now.orientation[k], then.orientation[k], 1.2e-7) << "single precision";
    const double rise = placed->world.plates.at(0).base - bases_[frame];
    for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(now.position[3 * i + 2], then.position[3 * i + 2] + rise, 2e-7);
  }
}

TEST_F(RecordedRods, AreRefusedWhereTheSceneHasOthers) {
  const System system = test::short_rods(10);
  const std::string file = record_run(system, {0});
  System other = system;
  other.n_rods = 11;
  other.gap = 1.3;
  EXPECT_THAT(test::refusal(read_recorded_rods(file, {}, other)),
              HasSubstr("not the same in the scene: their number, the side of the box or the "
                        "gap (12 mm and 1.2 mm in the file); there, rods.count is 10; a run"));
  const auto no_frame = read_recorded_rods(file, 1, system);
  ASSERT_FALSE(no_frame);
  EXPECT_THAT(no_frame.error().message, HasSubstr("has no frame 1; it has 1"));
}

// The scene of tracked rods has their mean number; a frame may have more.
TEST_F(RecordedRods, OfTrackedRodsAreThoseOfTheFrame) {
  const System system = test::short_rods(10);
  const TrajectoryReader whole = TrajectoryReader::open(record_run(system, {0})).value();
  scene::RunPlan fewer;
  fewer.system = system;
  fewer.system.n_rods = 7;
  TrajectoryHeader header = whole.header();
  header.lacking = "velocities";
  header.scene_json = scene::to_json(fewer).dump();
  const std::string tracked = (folder_ / "tracked.h5").string();
  ASSERT_TRUE(write_trajectory(tracked, header, whole.recorded()));
  EXPECT_THAT(test::refusal(read_recorded_rods(tracked, {}, fewer.system)), HasSubstr("there, rods.count is 10"));
  EXPECT_EQ(test::good(read_recorded_rods(tracked, {}, system))->size(), 10U);
}

TEST(ImportId, IsOfTheSceneAndTheRodsAlone) {
  scene::RunPlan plan;
  plan.system = test::short_rods(2);
  const auto id_of = [&](const std::string& text, const scene::RunPlan& of) {
    return import_id(of, Simulation::start_from(placed(of.system, text).rods->world));
  };
  const std::string rods = "x,y,angle\n2,2,0\n2,6,0\n", moved = "x,y,angle\n2,2,0\n2,6.0000001,0\n";
  const std::string id = id_of(rods, plan);
  EXPECT_THAT(id, ::testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(id_of("angle, y, x\n0, 2.0, 2\n0, 6, 2e0\n", plan), id) << "however it is written";
  EXPECT_NE(id_of(moved, plan), id);
  scene::RunPlan started = plan;
  started.start = scene::StartState{"0123456789abcdef", 0};
  started.system.start = Start::kRandom;
  EXPECT_EQ(id_of(rods, started), id) << "how rods start elsewise has no part in it";
  scene::RunPlan shaken_harder = plan;
  shaken_harder.system.amplitude *= 2;
  EXPECT_NE(id_of(rods, shaken_harder), id);
}

}  // namespace
}  // namespace shaken::run
