// SPDX-License-Identifier: MIT
#include "study/cost.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "study/computing_plan.h"
#include "study/destination.h"

namespace shaken::study {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kHour = 3600, kGigabyte = 1e9;

const PaperFigure* figure_called(std::string_view word) {
  for (const PaperFigure& figure : paper_figures()) {
    if (figure.is_called(word)) return &figure;
  }
  return nullptr;
}

NamedSweep sweep_of(const std::string& name, int n_runs, const std::string& executor, const Json& slurm) {
  const Json scene{{"rods", {{"area_fraction", 0.3}}}, {"box", {{"side", 20}}}, {"time", {{"measure", "1 s"}}}};
  const Json written{{"name", name}, {"scene", scene}, {"sweep", {{"replicas", n_runs}}}};
  NamedSweep sweep{.name = name, .needed = true, .input = {name + ".json", sent_to(written.dump(), executor, slurm)}};
  sweep.sweep = client::load_points(sweep.input, {}, std::nullopt);
  return sweep;
}

std::vector<client::RunCost> runs_of(const std::vector<double>& hours) {
  std::vector<client::RunCost> runs;
  for (const double h : hours) {
    runs.push_back({.cpu = h * kHour, .disk = kGigabyte, .most = 1.5 * kGigabyte, .memory = h * kGigabyte});
  }
  return runs;
}

class InSlurm : public ::testing::Test {
 protected:
  NamedSweep long_ = sweep_of("long", 3, "slurm", {{"time", "4 h"}, {"memory", "4G"}});
  NamedSweep short_ = sweep_of("short", 4, "slurm", {{"runs_per_task", 2}});
  StudyCost of(int cores) const {
    return study_cost({&long_, &short_}, {runs_of({1, 5, 2}), runs_of({1, 1, 0.5, 0.5})}, cores);
  }
};

TEST_F(InSlurm, SweepsShareTheCores) {
  const StudyCost study = of(2);
  ASSERT_EQ(study.sweeps.size(), 2u);
  const Cost &longer = study.sweeps[0].cost, &shorter = study.sweeps[1].cost;
  EXPECT_EQ(longer.estimate.n_tasks, 3u);
  EXPECT_EQ(shorter.estimate.n_tasks, 2u);
  EXPECT_DOUBLE_EQ(longer.longest_run, 5 * kHour);
  EXPECT_DOUBLE_EQ(shorter.longest_run, kHour) << "not that of its task";
  EXPECT_DOUBLE_EQ(longer.estimate.wall, 5 * kHour) << "1 and 2 beside 5";
  EXPECT_DOUBLE_EQ(study.all.estimate.core_hours, 11);
  EXPECT_EQ(study.all.n_runs, 7u);
  EXPECT_EQ(study.all.estimate.n_tasks, 5u);
  EXPECT_DOUBLE_EQ(study.all.estimate.wall, 6 * kHour) << "1, 2, 2 and then 1 beside 5";
  EXPECT_DOUBLE_EQ(study.all.longest_run, 5 * kHour);
  EXPECT_DOUBLE_EQ(study.all.memory, 5 * kGigabyte);
  EXPECT_DOUBLE_EQ(study.all.disk, 7 * kGigabyte);
  EXPECT_DOUBLE_EQ(study.all.room, 8 * kGigabyte) << "two runs end together";
  EXPECT_EQ(study.all.n_files, 7 * 8u);
}

TEST_F(InSlurm, WithoutALimitEveryTaskHasACore) {
  const StudyCost study = of(0);
  EXPECT_DOUBLE_EQ(study.all.estimate.wall, 5 * kHour);
  EXPECT_TRUE(cost_json(study, "paper").at("cores").is_null());
}

TEST_F(InSlurm, TellsWhatIsTooLongAndTooSmall) {
  const auto remarks = remarks_on(of(2));
  ASSERT_EQ(remarks.size(), 2u);
  EXPECT_THAT(remarks[0], HasSubstr("longer than they may (long)"));
  EXPECT_THAT(remarks[1], HasSubstr("more memory than their tasks have (long)"));
  const NamedSweep brief = sweep_of("brief", 2, "slurm", Json::object());
  EXPECT_THAT(remarks_on(study_cost({&brief}, {runs_of({0.001, 0.001})}, 1)).front(), HasSubstr("--runs-per-task"));
}

TEST(CostHere, IsThatOfSoManyCoresWithoutTasks) {
  const NamedSweep sweep = sweep_of("here", 3, "local", Json::object());
  const StudyCost study = study_cost({&sweep}, {runs_of({1, 1, 1})}, 2);
  EXPECT_FALSE(study.slurm);
  EXPECT_DOUBLE_EQ(study.all.estimate.all(), 2 * kHour);
  EXPECT_THAT(remarks_on(study), IsEmpty());
  const std::string text = cost_text(study, 0);
  EXPECT_THAT(text, Not(HasSubstr("TASKS")));
  EXPECT_THAT(text, HasSubstr("on 2 cores like this machine's"));
  EXPECT_GT(study_cost({&sweep}, {runs_of({1, 1, 1})}, 0).cores, 0) << "those of this machine";
}

TEST(Files, AreThoseThatDocumentsName) {
  scene::RunPlan plan;
  const std::size_t least = n_files_of(plan);
  plan.trajectory = scene::Trajectory{0.01};
  EXPECT_EQ(n_files_of(plan), least + 1);
  plan.movie.emplace();
  EXPECT_EQ(n_files_of(plan), least + 2);
  plan.trajectory.reset();
  EXPECT_EQ(n_files_of(plan), least + 2) << "a movie is drawn from frames";
}

TEST(TwoDigits, LeaveWhatAnEstimateKnows) {
  EXPECT_DOUBLE_EQ(two_digits(15.94), 16);
  EXPECT_DOUBLE_EQ(two_digits(-0.01234), -0.012);
  EXPECT_DOUBLE_EQ(two_digits(7.105e6), 7.1e6);
  EXPECT_EQ(two_digits(0), 0);
}

TEST_F(InSlurm, APlanOfOneFigureAndOneRunSpeaksOfOne) {
  const NamedSweep one = sweep_of("one", 1, "slurm", {{"time", "4 h"}, {"memory", "4G"}});
  const Selection selection{.figures = {figure_called("10")}, .sweeps = {one}};
  const std::string plan = computing_plan(selection, study_cost({&one}, {runs_of({0.123456})}, 64), "draw", "sweeps");
  for (const char* words : {"give figure 10 of", "about 1 task in job arrays", "with one run in each", "in 1 folder;",
                            "| core-hours | 0.12 |", "longest run | 7.4 min |", "with 1 core at once", "task | 15min: ",
                            "of a task | 256M: ", "ask Slurm for the time and the memory of the table by themselves"}) {
    EXPECT_THAT(plan, HasSubstr(words));
  }
}

TEST_F(InSlurm, APlanSaysWhatACentreAsksAndHasItsSweepsBesideIt) {
  const ScratchFolder folder;
  Selection selection{.figures = {figure_called("3"), figure_called("10")}, .sweeps = {long_, short_}};
  selection.sweeps.push_back(sweep_of("other", 1, "slurm", Json::object()));
  selection.sweeps.back().needed = false;
  const std::filesystem::path file = folder.path() / "for us.md";
  write_computing_plan(selection, of(64), "shaken figures --draw-only", file);
  const std::string plan = *read_file(file);
  for (const char* words : {"| jobs | about 5 tasks",
                            "up to 2 runs one after the other",
                            "| core-hours | 11 |",
                            "| cores | 1 for each task; 5 at once, as many as there are tasks for |",
                            "| wall time of the longest run | 5 h |",
                            "with 5 cores at once",
                            "| memory of a task | 5 GB at most |",
                            "| time to ask for, of a task | 8h: ",
                            "| memory to ask for, of a task | 7168M: ",
                            "10 small files and 0.17 checkpoints a second",
                            "give figures 3 and 10 of",
                            "nohup shakend --root ROOT",
                            "systemd-run --user",
                            "Made again with `--time 8h --memory 7168M`",
                            "| storage | 7 GB when all is done; 9.5 GB",
                            "| files | 56 at most, in 7 folders",
                            "checkpoint about every 30 s",
                            "`sbatch`, `squeue` and `scancel`",
                            "submit 'for us-sweeps/long.json'",
                            "| time limit asked for | differs",
                            "shaken figures --draw-only",
                            "longer than they may (long)"}) {
    EXPECT_THAT(plan, HasSubstr(words));
  }
  const scene::Sweep sweep = client::load_points(
      client::read_scene_input((folder.path() / "for us-sweeps" / "short.json").string()), {}, std::nullopt);
  EXPECT_EQ(sweep.executor, "slurm");
  EXPECT_EQ(sweep.slurm.runs_per_task, 2);
  EXPECT_EQ(sweep.points.size(), 4u);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "for us-sweeps" / "other.json"));
}

}  // namespace
}  // namespace shaken::study
