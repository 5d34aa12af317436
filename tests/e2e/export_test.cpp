// What `shaken export` makes of a real run, read by other programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kTwoKinds = R"({
  "rods": { "length": "4.5 mm", "count": 40 },
  "rods_2": { "length": "2.5 mm", "count": 20 },
  "box": { "side": "25 mm" },
  "plates": { "gamma": 3 },
  "time": { "steady": 0, "measure": "0.2 s" },
  "measure": { "order": { "every": "5 ms" }, "msd": {} },
  "trajectory": { "every": "10 ms" },
  "stream": null
})";

/// A polar rod has neither its beads nor its radii symmetric about its centre.
constexpr const char* kPolarInADisc = R"({
  "rods": { "length": "4.5 mm", "profile": "polar", "area_fraction": 0.3 },
  "walls": { "arena": "disc", "size": "22 mm" },
  "time": { "steady": 0, "measure": "0.1 s" },
  "trajectory": { "every": "20 ms" },
  "stream": null
})";

class ExportedFiles : public testing::Test {
 protected:
  /// Simulates a scene into the folder "run".
  void simulate(const char* scene) {
    std::ofstream(path("scene.json")) << scene;
    expect_end(0, run_command({program("shaken-worker"), path("scene.json"), "--out", path("run"), "--no-lcm"}));
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Finished exported(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {program("shaken"), "export", path("run")});
    return run_command(arguments);
  }
  /// Other programs' reading of files of the run.
  Finished read_back(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"/usr/bin/python3", SHAKEN_EXPORT_READER, path("run")});
    return run_command(arguments);
  }

  ScratchFolder folder_;
};

TEST_F(ExportedFiles, AreReadByOthersAsTheRun) {
  simulate(kTwoKinds);
  for (const char* file : {"all.gsd", "all.extxyz", "all.xyz"}) {
    const Finished done = exported({"-o", path(file)});
    EXPECT_EQ(done.code, 0) << done.output;
    EXPECT_THAT(done.output, HasSubstr(path(file) + ": 21 frames of 60 rods, "));
  }
  for (const char* group : {"order", "msd"}) {
    expect_end(0, exported({"--observable", group, "-o", path("of-") + group + ".csv"}));
  }
  const Finished seen =
      read_back({path("all.gsd"), path("all.extxyz"), path("all.xyz"), path("of-order.csv"), path("of-msd.csv")});
  EXPECT_EQ(seen.code, 0) << seen.output;
  EXPECT_EQ(std::count(seen.output.begin(), seen.output.end(), '\n'), 5) << seen.output;

  EXPECT_EQ(exported({"-o", path("some.gsd"), "--from", "50 ms", "--every", "3"}).code, 0);
  expect_end(0, read_back({path("some.gsd"), "--frames", "5:3"}));
  // and it is seen where a file is of other frames
  const Finished others = read_back({path("all.gsd"), "--frames", "1:1"});
  EXPECT_EQ(others.code, 1) << others.output;
}

TEST_F(ExportedFiles, HaveWallsAndPolarRods) {
  simulate(kPolarInADisc);
  for (const char* file : {"all.gsd", "all.extxyz", "all.xyz"}) {
    expect_end(0, exported({"-o", path(file)}));
  }
  expect_end(0, read_back({path("all.gsd"), path("all.extxyz"), path("all.xyz")}));
}

}  // namespace
}  // namespace shaken::test
