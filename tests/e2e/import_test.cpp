// Rods that come from elsewhere: `shaken import`, and runs that start from them, by real programs without a daemon.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "run/files/trajectory.h"
#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace import_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kScene = R"({
  "rods": { "length": "2.5 mm", "count": 12 }, "box": { "side": "12 mm" },
  "time": { "steady": 0, "measure": "50 ms" },
  "trajectory": { "every": "5 ms" }, "stream": null })";

class Imported : public ::testing::Test {
 protected:
  Imported() {
    write("scene.json", kScene);
    table_ = "x,y,angle,vx\n";
    for (int i = 0; i < 12; ++i) {
      const double x = 2 + 4 * (i % 3), y = 1.5 + 3 * (i / 3), angle = -80 + 15 * i, v = 10 * i - 50;
      table_ += fmt::format("{},{},{},{}\n", x, y, angle, v);
      expected_.push_back({x, y, angle * kPi / 180, v});
    }
    write("rods.csv", table_);
  }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return path(name);
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Finished import(const std::string& file, std::vector<std::string> more = {}) const {
    more.insert(more.begin(),
                {program("shaken"), "import", path(file), "--scene", path("scene.json"), "--root", path("root")});
    return run_command(more);
  }
  Json report(const std::string& file, std::vector<std::string> more = {}) const {
    more.emplace_back("--json");
    return Json::parse(said_with(0, import(file, more)));
  }
  /// A run beside the imported ones, where it finds them without a root.
  Finished start(const std::string& id, const std::string& name, const std::string& time = "0") const {
    return run_command({program("shaken"), "run", path("scene.json"), "--out", path("root/runs/" + name), "-s",
                        "start.run=" + id, "-s", "start.time=" + time});
  }
  run::RecordedFrame frame_of(const std::string& file, std::size_t frame = 0) const {
    return run::TrajectoryReader::open(path(file)).value().recorded().frame(frame).value();
  }
  /// Names and times of writing of all that is in the root.
  std::map<std::string, fs::file_time_type> files() const {
    std::map<std::string, fs::file_time_type> all;
    for (const auto& entry : fs::recursive_directory_iterator(path("root")))
      all[entry.path().string()] = fs::last_write_time(entry.path());
    return all;
  }

  struct Given {
    double x, y, angle, vx;
  };
  ScratchFolder folder_;
  std::string table_;
  std::vector<Given> expected_;
};

TEST_F(Imported, RodsAreWhereARunBegins) {
  const Finished done = import("rods.csv");
  ASSERT_EQ(done.code, 0) << done.output;
  const std::string id = report("rods.csv")["run_id"];
  EXPECT_THAT(done.output, HasSubstr("\"start\": {\"run\": \"" + id + "\", \"time\": 0}"));
  EXPECT_THAT(done.output, HasSubstr("12 without a height: they rest on the base"));
  expect_end(0, start(id, "go"));

  const run::RecordedFrame first = frame_of("root/runs/go/trajectory.h5");
  const run::RecordedFrame imported = frame_of("root/runs/" + id + "/trajectory.h5");
  EXPECT_EQ(first.position, imported.position);
  EXPECT_EQ(first.orientation, imported.orientation);
  EXPECT_EQ(first.velocity, imported.velocity);
  EXPECT_EQ(first.tick, 0);
  const run::TrajectoryReader reader = run::TrajectoryReader::open(path("root/runs/go/trajectory.h5")).value();
  const Snapshot seen = reader.frame(0).value();
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_FLOAT_EQ(first.position[3 * i], static_cast<float>(expected_[i].x));
    EXPECT_FLOAT_EQ(first.position[3 * i + 1], static_cast<float>(expected_[i].y));
    EXPECT_FLOAT_EQ(first.velocity[3 * i], static_cast<float>(expected_[i].vx));
    EXPECT_NEAR(seen.director[i].x(), std::cos(expected_[i].angle), 2e-7);
    EXPECT_NEAR(seen.director[i].y(), std::sin(expected_[i].angle), 2e-7);
  }
  const Json summary = Json::parse(*read_file(path("root/runs/go/summary.json")));
  EXPECT_EQ(summary["start"], (Json{{"run", id}, {"time_s", 0.0}}));

  EXPECT_THAT(said_with(1, start(id, "elsewhen", "1s")),
              HasSubstr("there is no state of it at 1 s: its last saved state is that at 0 s"));
}

TEST_F(Imported, AFrameOfARunComesBackAsItWas) {
  const std::string id = report("rods.csv")["run_id"];
  ASSERT_EQ(start(id, "go").code, 0);
  const run::RecordedFrame last = frame_of("root/runs/go/trajectory.h5", 10);
  ASSERT_NE(last.position, frame_of("root/runs/go/trajectory.h5").position);

  const std::string again = report("root/runs/go/trajectory.h5")["run_id"];
  ASSERT_EQ(start(again, "on").code, 0);
  const run::RecordedFrame begun = frame_of("root/runs/on/trajectory.h5");
  EXPECT_EQ(begun.position, last.position);
  EXPECT_EQ(begun.velocity, last.velocity);
  for (std::size_t k = 0; k < last.orientation.size(); ++k)
    EXPECT_NEAR(begun.orientation[k], last.orientation[k], 1.2e-7) << "the precision of the file";

  EXPECT_NE(report("root/runs/go/trajectory.h5", {"--frame", "3"})["run_id"], again);
  EXPECT_EQ(report("root/runs/go/trajectory.h5", {"--frame", "10"})["run_id"], again);
  EXPECT_EQ(import("root/runs/go/trajectory.h5", {"--frame", "11"}).code, 2);
}

TEST_F(Imported, TwiceChangesNothing) {
  const Json once = report("rods.csv");
  EXPECT_EQ(once["was_there"], false);
  const auto before = files();
  const Json twice = report("rods.csv");
  EXPECT_EQ(twice["was_there"], true);
  EXPECT_EQ(twice["run_id"], once["run_id"]);
  EXPECT_EQ(files(), before);
  // nor does a scene that starts from them already
  write("scene.json", R"({"start": {"run": ")" + once["run_id"].get<std::string>() + R"(", "time": 0},)" +
                          std::string(kScene).substr(1));
  EXPECT_EQ(report("rods.csv")["run_id"], once["run_id"]);
  EXPECT_EQ(files(), before);

  // but what is damaged is made anew
  const std::string id = once["run_id"];
  write("root/runs/" + id + "/checkpoint.bin", "damaged");
  EXPECT_EQ(report("rods.csv")["was_there"], false);
  EXPECT_EQ(report("rods.csv")["was_there"], true);
}

TEST_F(Imported, EveryProblemIsInOneMessage) {
  write("bad.csv", "x,y,angle\n1,2,0\n1,two,0\n13,2,0\n1,2.5,0\n4,4,0,0\n");
  const Finished refused = import("bad.csv");
  EXPECT_EQ(refused.code, 2);
  const std::string file = path("bad.csv");
  for (const std::string& problem :
       {file + ":2:1: overlaps the rod of line 5 by 300.0 um", file + ":3:3: y: 'two' is not a number",
        file + ":4:1: the centre (13, 2) mm is outside of the box", file + ":6:1: 4 fields for 3 columns",
        file + ": the file has 3 rods of `rods` that can be read, and the scene has 12"}) {
    EXPECT_THAT(refused.output, HasSubstr(problem));
  }
  EXPECT_FALSE(fs::exists(path("root")));

  const Finished json = import("bad.csv", {"--json", "-s", "rods.lenght=2"});
  EXPECT_EQ(json.code, 2);
  const Json told = Json::parse(json.output);
  EXPECT_EQ(told["ok"], false);
  EXPECT_THAT(told["problems"].dump(), HasSubstr("did you mean rods.length?"));
  EXPECT_THAT(told["problems"].dump(), HasSubstr("'two' is not a number")) << "those of the table too";

  std::string outside = "x,y,angle\n";
  for (int i = 0; i < 150; ++i) outside += "13,2,0\n";
  write("outside.csv", outside);
  EXPECT_THAT(import("outside.csv").output, ::testing::AllOf(HasSubstr("outside.csv:101:1: "), HasSubstr("and 50 more"),
                                                             HasSubstr("150 rods of `rods` that can be read")))
      << "what is wrong with the whole file is told however many lines are";

  EXPECT_EQ(import("nothing.csv").code, 2);
  EXPECT_THAT(import("rods.csv", {"--frame", "0"}).output, HasSubstr("a table has one frame"));
  EXPECT_THAT(import("rods.csv", {"--random-velocities"}).output, HasSubstr("the rods have velocities"));
}

TEST_F(Imported, RodsAreNoRunThatGoesOn) {
  const std::string id = report("rods.csv")["run_id"];
  const auto before = files();
  const std::string directory = path("root/runs/" + id);
  EXPECT_THAT(said_with(2, run_command({program("shaken"), "run", path("scene.json"), "--out", directory})),
              HasSubstr("holds imported rods, from which runs start: give another --out"));
  EXPECT_EQ(files(), before);
  EXPECT_FALSE(fs::exists(directory + "/summary.json")) << "there are no averages of it";

  // the id is that of the rods: others do not pass for them
  const std::string other = report("rods.csv", {"-s", "measure.msd={}"})["run_id"];
  fs::copy(path("root/runs/" + other + "/scene.json"), directory + "/scene.json", fs::copy_options::overwrite_existing);
  EXPECT_THAT(said_with(1, start(id, "go")), HasSubstr("holds another run"));
}

TEST_F(Imported, FlatRodsAtRestAreTold) {
  write("flat.csv", "x,y,angle\n2,2,0\n6,6,50\n");
  const std::vector<std::string> two{"-s", "rods.count=2"};
  EXPECT_THAT(import("flat.csv", two).output, HasSubstr("all lie flat and at rest"));
  EXPECT_THAT(import("flat.csv", {"-s", "rods.count=2", "--random-velocities"}).output,
              ::testing::Not(HasSubstr("at rest")));
}

}  // namespace import_test
}  // namespace shaken::test
