// SPDX-License-Identifier: MIT
#include "study/destination.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/canonical.h"

namespace shaken::study {
namespace {

scene::Sweep read(const std::string& text) { return client::load_points({"test.json", text}, {}, std::nullopt); }

TEST(Destination, ASweepNamesItsExecutorAndKeepsWhatItSaysItself) {
  const std::string text = R"({ // of a user
    "name": "mine", "slurm": { "partition": "short", "time": "2 h" },
    "scene": { "time": { "measure": "1 s" } }, "sweep": { "grid": { "rods.area_fraction": [0.30, 4e-1] } } })";
  const scene::Sweep sweep = read(sent_to(text, "slurm", {{"time", "4h"}, {"runs_per_task", 3}}));
  EXPECT_EQ(sweep.name, "mine");
  EXPECT_EQ(sweep.executor, "slurm");
  EXPECT_EQ(sweep.slurm.partition, "short");
  EXPECT_DOUBLE_EQ(sweep.slurm.time, 4 * 3600) << "what is asked for wins";
  EXPECT_EQ(sweep.slurm.runs_per_task, 3);
  ASSERT_EQ(sweep.points.size(), 2u);
}

TEST(Destination, APlainSceneBecomesASweepOfOneRun) {
  const scene::Sweep sweep = read(sent_to(R"({"rods": {"area_fraction": 0.3}})", "slurm", Json::object()));
  EXPECT_EQ(sweep.executor, "slurm");
  EXPECT_EQ(sweep.slurm, scene::SlurmSettings{});
  EXPECT_EQ(sweep.points.size(), 1u);
}

// A run that was done on one machine is found done in Slurm.
TEST(Destination, NoRunOfTheStudyGetsAnotherName) {
  std::string problems;
  Selection here = selected({}, problems);
  load(here, SHAKEN_SOURCE_DIR "/configs/figures/tiny");
  for (const NamedSweep& sweep : here.sweeps) {
    const scene::Sweep sent = read(sent_to(sweep.input.text, "slurm", {{"memory", "2G"}}));
    ASSERT_EQ(sent.points.size(), sweep.sweep.points.size()) << sweep.name;
    for (std::size_t k = 0; k < sent.points.size(); ++k) {
      EXPECT_EQ(scene::run_id(sent.points[k].plan), scene::run_id(sweep.sweep.points[k].plan)) << sweep.name;
      EXPECT_EQ(sent.points[k].plan.total_time(), sweep.sweep.points[k].plan.total_time());
    }
  }
}

}  // namespace
}  // namespace shaken::study
