#include "web/recorded_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/scratch_folder.h"
#include "run/files/directory.h"
#include "tests/support/good.h"
#include "tests/support/recorded_rods.h"

namespace shaken::web {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRun = "1f0c000000000000";

class RecordedRunTest : public testing::Test {
 protected:
  RecordedRunTest() { fs::create_directories(folder_ / kRun); }
  run::RunDirectory directory() const { return {folder_ / kRun}; }
  void record(int n_frames, const BeadRow& beads = test::kRod) const {
    test::record_rods(directory(), n_frames, beads);
  }

  ScratchFolder folder_;
  RecordedRun run_{folder_ / kRun};
};

TEST_F(RecordedRunTest, SpheresHaveNoOrder) {
  record(3, {{0}, {0.4}});
  const auto frame = test::good(run_.frame(0));
  EXPECT_TRUE(std::isnan(frame->order));
}

TEST_F(RecordedRunTest, FramesAreThoseOfTheTrajectory) {
  record(3);
  const auto frames = test::good(run_.frames());
  EXPECT_EQ(frames->n, 3u);
  EXPECT_DOUBLE_EQ(frames->first, 0);
  EXPECT_NEAR(frames->last, 0.2, 1e-12);
  const auto first = run_.frame(0), last = run_.frame(2);
  ASSERT_TRUE(first && last);
  EXPECT_NEAR(last->time, 0.2, 1e-12);
  EXPECT_NEAR(first->director, 0, 1e-6);
  EXPECT_NEAR(first->order, 1, 1e-6);
  EXPECT_NEAR(last->order, 0, 1e-6) << "rods across each other";
  ASSERT_EQ(last->rods.size(), 2u);
  EXPECT_NEAR(last->rods[1].x, 7, 1e-6);
  EXPECT_NEAR(last->heights.at(1), 0.6, 1e-6);
  EXPECT_NEAR(std::abs(last->rods[1].theta), 1.5708, 1e-3);
  ASSERT_EQ(last->outlines.size(), 1u);
  EXPECT_DOUBLE_EQ(last->outlines[0].half_length, 2);
  EXPECT_FALSE(run_.frame(3)) << "there are three";
}

TEST_F(RecordedRunTest, ARodHasItsPath) {
  record(4);
  const auto path = test::good(run_.path(1, 1, 3));
  ASSERT_EQ(path->times.size(), 3u);
  EXPECT_NEAR(path->times[0], 0.1, 1e-12);
  EXPECT_NEAR(path->x[2], 7, 1e-6);
  EXPECT_NEAR(path->y[2], 8, 1e-6);
  EXPECT_NEAR(path->n_z[2], 0, 1e-6);
  EXPECT_FALSE(run_.path(2, 1, 3)) << "there are two rods";
  EXPECT_FALSE(run_.path(0, 1, 4)) << "there are four frames";
}

TEST_F(RecordedRunTest, SeeFramesThatComeLater) {
  record(2);
  EXPECT_EQ(run_.frames()->n, 2u);
  record(5);
  EXPECT_EQ(run_.frames()->n, 5u);
}

TEST_F(RecordedRunTest, SayWhatIsNotThere) {
  EXPECT_EQ(run_.frames()->n, 0u);
  EXPECT_THAT(run_.frames()->reason, testing::HasSubstr("records no rods"));
  EXPECT_THAT(run_.frame(0).error().message, testing::HasSubstr("records no rods"));
  EXPECT_THAT(run_.curves().error().message, testing::HasSubstr("before the end"));
  EXPECT_TRUE(RecordedRun(folder_ / "ffffffffffffffff").files().empty());
  std::ofstream(directory().trajectory()) << "no HDF5";
  EXPECT_FALSE(run_.frames());
  std::ofstream(directory().observables()) << "no HDF5";
  EXPECT_FALSE(run_.curves());
}

TEST_F(RecordedRunTest, LinksAndFoldersAreNoFiles) {
  std::ofstream(directory().scene()) << "{}";
  fs::create_symlink("/etc/passwd", folder_ / kRun / "secret");
  fs::create_directory(folder_ / kRun / "folder");
  // nor is what the program keeps for itself
  for (const char* name : {"lock", "checkpoint.bin", "checkpoint.prev.bin"})
    std::ofstream(folder_ / kRun / name) << "1";
  const auto files = run_.files();
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].name, "scene.json");
  EXPECT_EQ(files[0].size, 2u);
}

}  // namespace
}  // namespace shaken::web
