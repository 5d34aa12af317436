// The checks with stand-ins for Slurm's programs; tests/cluster has the real ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "base/failure.h"
#include "base/scratch_folder.h"
#include "client/checkup.h"
#include "client/slurm_estimate.h"

namespace shaken::client {
namespace {

using testing::HasSubstr;
using testing::Not;

class SlurmCheckup : public testing::Test {
 protected:
  SlurmCheckup() {
    for (const char* name : {"sbatch", "squeue", "scancel", "sinfo", "scontrol", "srun"}) stand_in(name, "exit 0");
    setenv("PATH", (folder_.path().string() + ":/usr/bin:/bin").c_str(), 1);
    unsetenv("SLURM_CONF");
  }
  ~SlurmCheckup() override {
    setenv("PATH", path_.c_str(), 1);
    unsetenv("SLURM_CONF");
  }
  void stand_in(const std::string& name, const std::string& script) const {
    std::ofstream(folder_ / name) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
  }

  ScratchFolder folder_;
  std::string path_ = std::getenv("PATH");
};

TEST_F(SlurmCheckup, AFileThatSlurmConfNamesAndIsNotThereIsTheReason) {
  setenv("SLURM_CONF", "/nowhere/slurm.conf", 1);
  const CheckResult found = slurm_checkup(folder_.path()).front();
  EXPECT_EQ(found.level, CheckResult::Level::kFail);
  EXPECT_EQ(found.message, "SLURM_CONF names /nowhere/slurm.conf, and there is no such file");
  EXPECT_THAT(found.remedy, HasSubstr("export SLURM_CONF="));
}

TEST_F(SlurmCheckup, ProgramsThatFindNoClusterAreThere) {
  stand_in("sbatch", "echo 'sbatch: error: DNS'; echo 'sbatch: fatal: no configuration source' >&2; exit 1");
  const CheckResult found = slurm_checkup(folder_.path()).front();
  EXPECT_EQ(found.message, "sbatch finds no cluster: sbatch: fatal: no configuration source (SLURM_CONF is not set)");
  EXPECT_THAT(found.remedy, Not(HasSubstr("apt install")));
  std::filesystem::remove(folder_ / "sbatch");
  setenv("PATH", folder_.path().c_str(), 1);
  std::filesystem::create_symlink("/usr/bin/timeout", folder_ / "timeout");
  EXPECT_THAT(slurm_checkup(folder_.path()).front().message, "not found: sbatch");
}

TEST_F(SlurmCheckup, AControllerThatDoesNotAnswerIsThatOfWhichFile) {
  stand_in("sinfo", "echo 'Unable to contact slurm controller'; exit 1");
  setenv("SLURM_CONF", (folder_ / "sinfo").c_str(), 1);
  EXPECT_EQ(slurm_checkup(folder_.path()).back().message,
            "Unable to contact slurm controller (SLURM_CONF=" + (folder_ / "sinfo").string() + ")");
}

TEST_F(SlurmCheckup, FilmsNeedAProgramThatWorks) {
  for (const bool works : {true, false}) {
    stand_in("ffmpeg", works ? "echo ffmpeg 7" : "echo broken; exit 1");
    const std::vector<CheckResult> found = checkup(folder_.path());
    const auto films = std::ranges::find(found, "films", &CheckResult::what);
    ASSERT_NE(films, found.end());
    EXPECT_EQ(films->level, works ? CheckResult::Level::kOk : CheckResult::Level::kWarn);
    EXPECT_EQ(films->message, works ? "ffmpeg 7" : "broken");
  }
}

TEST_F(SlurmCheckup, ARootThatDoesNotExistIsTheReason) {
  stand_in("srun", "exit 1");
  const std::string root = (folder_ / "root").string();
  const CheckResult found = slurm_checkup(root).back();
  EXPECT_EQ(found.level, CheckResult::Level::kFail);
  EXPECT_THAT(found.message, HasSubstr(root + " does not exist yet"));
  EXPECT_THAT(found.remedy, HasSubstr("mkdir -p " + root));
  std::filesystem::create_directory(root);
  EXPECT_THAT(slurm_checkup(root).back().message, HasSubstr("a node cannot write"));
}

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
