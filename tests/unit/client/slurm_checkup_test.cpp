// SPDX-License-Identifier: MIT
// The checks with stand-ins for Slurm's programs; tests/cluster has the real ones.
#include "client/slurm_checkup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "base/scratch_folder.h"

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

}  // namespace
}  // namespace shaken::client
