// SPDX-License-Identifier: MIT
#include "study/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_folder.h"
#include "run/files/directory.h"
#include "scene/canonical.h"

namespace shaken::study {
namespace {

using testing::HasSubstr;

// Otherwise a figure would have a point less, and nobody would know.
TEST(DoneRuns, ThatCannotBeReadAreNamed) {
  const ScratchFolder folder;
  Selection selection;
  NamedSweep sweep;
  sweep.name = "phases";
  sweep.sweep = scene::load_sweep(R"({"scene": {"time": {"measure": 1}}, "sweep": {"replicas": 3}})", "a.json").value();
  std::vector<run::RunDirectory> runs;
  for (const scene::SweepPoint& point : sweep.sweep.points) {
    runs.push_back({directory_of(point, folder.path())});
    std::filesystem::create_directories(runs.back().root);
  }
  const std::string id = scene::run_id(sweep.sweep.points[1].plan);
  selection.sweeps.push_back(std::move(sweep));
  std::ofstream(runs[0].summary()) << R"({"exit": {"state": "do)";
  std::ofstream(runs[1].summary()) << R"({"run_id": ")" + id +
                                          R"(", "exit": {"state": "done", "tick": 1000000000000}})";

  std::vector<std::string> left_out;
  const Library library = done_runs(selection, folder.path(), &left_out);
  EXPECT_TRUE(library["phases"].empty());
  ASSERT_EQ(left_out.size(), 2u) << "the third has not begun";
  EXPECT_THAT(left_out[0], HasSubstr(runs[0].summary().string()));
  EXPECT_THAT(left_out[1], HasSubstr(runs[1].scene().string()));
}

}  // namespace
}  // namespace shaken::study
