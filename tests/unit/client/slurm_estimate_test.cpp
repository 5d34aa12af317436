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
SlurmLoad load() { return {.n_runs = 100, .cpu = 36'000, .runs_per_task = 10, .cores = 4}; }

TEST(SlurmEstimate, TasksGoInRoundsOfAsManyAsThereAreCores) {
  const SlurmEstimate estimate = estimate_in_slurm(load());
  EXPECT_EQ(estimate.n_tasks, 10);
  EXPECT_DOUBLE_EQ(estimate.core_hours, 10);
  EXPECT_DOUBLE_EQ(estimate.task, 3600);
  EXPECT_DOUBLE_EQ(estimate.wall, 3 * 3600) << "4, 4 and 2 tasks";
  EXPECT_DOUBLE_EQ(estimate.refill, 0);
}

TEST(SlurmEstimate, WithoutALimitAllTasksRunAtOnce) {
  SlurmLoad all = load();
  all.cores = 0;
  EXPECT_DOUBLE_EQ(estimate_in_slurm(all).wall, 3600);
}

TEST(SlurmEstimate, ManyShortTasksWaitForTheDaemonToHandThemOver) {
  SlurmLoad many{.n_runs = 10'000, .cpu = 10'000, .max_pending = 100, .poll = 10};
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
