// SPDX-License-Identifier: MIT
#include "server/slurm/squeue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/slurm_conf.h"
#include "server/slurm/batch.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server::slurm {
namespace {

using Stage = QueuedTask::Stage;

TEST(Squeue, TasksAreReadAndAnythingElseIsPassedOver) {
  const auto tasks = parse_squeue(
      "slurm_load_jobs: warning\n"
      "12|3|PENDING|shaken-ab|Resources\n"
      "12|4|RUNNING|shaken-ab|None\n"
      "13|N/A|RUNNING|a job of another kind|None\n"
      "14|99999999999999|RUNNING|x|None\n"
      "12|5|NODE_FAIL|shaken-ab|Nodes required | for job are DOWN");
  ASSERT_EQ(tasks.size(), 3);
  EXPECT_EQ(tasks[0].job, "12");
  EXPECT_EQ(tasks[0].task, 3);
  EXPECT_EQ(tasks[0].name, "shaken-ab");
  EXPECT_EQ(tasks[0].reason, "Resources");
  EXPECT_EQ(tasks[0].stage, Stage::kWaiting);
  EXPECT_EQ(tasks[1].stage, Stage::kWorking);
  EXPECT_EQ(tasks[2].stage, Stage::kOver);
  EXPECT_EQ(tasks[2].state, "NODE_FAIL");
}

TEST(Squeue, AStateThatNobodyKnowsIsNoEnd) {
  EXPECT_EQ(parse_squeue("1|0|REQUEUE_HOLD|a|b").at(0).stage, Stage::kWaiting);
  EXPECT_EQ(parse_squeue("1|0|COMPLETING|a|b").at(0).stage, Stage::kWorking);
}

TEST(Sbatch, TheIdIsFoundAmongWarnings) {
  EXPECT_EQ(parse_sbatch("123\n"), "123");
  EXPECT_EQ(parse_sbatch("sbatch: warning: 3 cores are few\n124;east\n"), "124");
  EXPECT_EQ(parse_sbatch("sbatch: error: Batch job submission failed: Invalid partition"), "");
  EXPECT_EQ(parse_sbatch(""), "");
}

TEST(BatchFiles, WhatIsWrittenIsRead) {
  const ScratchFolder directory;
  const BatchFolder folder{directory.path()};
  const Batch batch{"/a program/worker", {{{"/runs/a", {"one", "two words\n'"}, "heading"}}, {{"/runs/b", {}, ""}}}};
  ASSERT_TRUE(write_batch(folder, batch));
  const auto read = read_batch(folder);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->worker, batch.worker);
  ASSERT_EQ(read->tasks.size(), 2);
  EXPECT_EQ(read->tasks[0][0].directory, "/runs/a");
  EXPECT_EQ(read->tasks[0][0].arguments, batch.tasks[0][0].arguments);
  EXPECT_EQ(read->tasks[0][0].heading, "heading");

  TaskReport report{.slurm_job = "7", .host = "n0", .restarts = 2, .begun = {0, 3}, .ends = {}};
  report.ends[3] = {1, 9, 77};
  ASSERT_TRUE(write_report(folder.report(1), report));
  const auto told = read_report(folder.report(1));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->slurm_job, "7");
  EXPECT_EQ(told->restarts, 2);
  EXPECT_EQ(told->begun, report.begun);
  EXPECT_EQ(told->ends.at(3).exit_code, 1);
  EXPECT_EQ(told->ends.at(3).signal, 9);
  EXPECT_EQ(told->ends.at(3).pid, 77);

  ASSERT_TRUE(write_stop(folder.stop(1), {2, 5}, Lasting::kYes));
  EXPECT_EQ(read_stop(folder.stop(1)), (std::set{2, 5}));
  ASSERT_TRUE(write_stop(folder.stop(1), {2, 5, 7}, Lasting::kNo));
  EXPECT_EQ(read_stop(folder.stop(1)), (std::set{2, 5, 7}));
  EXPECT_TRUE(read_stop(folder.stop(2)).empty());
}

TEST(ForgetFilters, NothingHidesTasksAndTheRestStays) {
  setenv("SQUEUE_PARTITION", "short", 1);
  setenv("SBATCH_CLUSTERS", "other", 1);
  setenv("SBATCH_ACCOUNT", "physics", 1);
  const std::vector<const char*> others{"SINFO_PARTITION", "SLURM_TIME_FORMAT", "SBATCH_WAIT", "SBATCH_TEST_ONLY"};
  for (const char* name : others) setenv(name, "1", 1);
  forget_slurm_filters();
  for (const char* name : others) EXPECT_EQ(std::getenv(name), nullptr) << name;
  EXPECT_EQ(std::getenv("SQUEUE_PARTITION"), nullptr);
  EXPECT_EQ(std::getenv("SBATCH_CLUSTERS"), nullptr);
  EXPECT_STREQ(std::getenv("SBATCH_ACCOUNT"), "physics");
  unsetenv("SBATCH_ACCOUNT");
}

TEST(BatchFiles, WhatIsNoneIsRefusedWithItsName) {
  const ScratchFolder directory;
  const BatchFolder folder{directory.path()};
  EXPECT_FALSE(read_batch(folder));
  for (const char* text : {"", "{", "[]", R"({"worker": 3, "tasks": []})", R"({"worker": "w", "tasks": [[3]]})"}) {
    write_text(folder.plan(), text);
    const auto read = read_batch(folder);
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error().message, testing::HasSubstr("batch.json"));
  }
}

}  // namespace
}  // namespace shaken::server::slurm
