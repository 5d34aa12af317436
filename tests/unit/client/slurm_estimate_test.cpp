// SPDX-License-Identifier: MIT
#include "client/slurm_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/failure.h"

namespace shaken::client {
namespace {

using testing::HasSubstr;
using testing::Not;

// 100 runs of 6 CPU-minutes, ten in a task
SlurmLoad load() { return {.runs = std::vector<double>(100, 360), .runs_per_task = 10, .cores = 4}; }

TEST(SlurmEstimate, TasksGoInRoundsOfAsManyAsThereAreCores) {
  const SlurmEstimate estimate = estimate_in_slurm(load());
  EXPECT_EQ(estimate.n_tasks, 10);
  EXPECT_DOUBLE_EQ(estimate.core_hours, 10);
  EXPECT_DOUBLE_EQ(estimate.task, 3600);
  EXPECT_DOUBLE_EQ(estimate.wall, 3 * 3600) << "4, 4 and 2 tasks";
  EXPECT_DOUBLE_EQ(estimate.refill, 0);
}

TEST(SlurmEstimate, ACoreThatIsDoneTakesTheNextTask) {
  const SlurmLoad uneven{.runs = {5, 1, 1, 1, 3, 2}, .cores = 2};
  const SlurmEstimate estimate = estimate_in_slurm(uneven);
  EXPECT_DOUBLE_EQ(estimate.wall, 7) << "5 and 2 beside 1, 1, 1 and 3; not three rounds of the longest";
  EXPECT_DOUBLE_EQ(estimate.run, 5);
  SlurmLoad packed = uneven;
  packed.runs_per_task = 4;
  EXPECT_DOUBLE_EQ(estimate_in_slurm(packed).task, 8);
  EXPECT_DOUBLE_EQ(estimate_in_slurm(packed).run, 5);
  packed.threads = 2;
  EXPECT_DOUBLE_EQ(estimate_in_slurm(packed).wall, 4 + 2.5) << "one task at a time, twice as fast";
}

TEST(SlurmEstimate, WithoutALimitAllTasksRunAtOnce) {
  SlurmLoad all = load();
  all.cores = 0;
  EXPECT_DOUBLE_EQ(estimate_in_slurm(all).wall, 3600);
}

TEST(SlurmEstimate, ManyShortTasksWaitForTheDaemonToHandThemOver) {
  SlurmLoad many{.runs = std::vector<double>(10'000, 1), .max_pending = 100, .poll = 10};
  const SlurmEstimate estimate = estimate_in_slurm(many);
  EXPECT_DOUBLE_EQ(estimate.refill, 1000);
  const std::string text = slurm_estimate_text(many, estimate);
  EXPECT_THAT(text, HasSubstr("--max-pending"));
  EXPECT_THAT(text, HasSubstr("slurm.runs_per_task"));
}

TEST(SlurmEstimate, ATimeThatIsTooShortIsTold) {
  SlurmLoad limited = load();
  limited.time_limit = 1800;
  EXPECT_THAT(slurm_estimate_text(limited, estimate_in_slurm(limited)), HasSubstr("longer than slurm.time"));
  limited.time_limit = 7200;
  EXPECT_THAT(slurm_estimate_text(limited, estimate_in_slurm(limited)), Not(HasSubstr("longer than slurm.time")));
}

TEST(SlurmEstimate, AnExecutorThatThereIsNotIsRefused) {
  EXPECT_TRUE(is_slurm("slurm"));
  EXPECT_FALSE(is_slurm("local"));
  EXPECT_FALSE(is_slurm(""));
  EXPECT_THROW(is_slurm("slrum"), Failure);
}

}  // namespace
}  // namespace shaken::client
