// SPDX-License-Identifier: MIT
// What the scheduler and its groups give to a process.
#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>
#include <vector>

#include "base/core/cgroup.h"
#include "base/processor.h"

namespace shaken {
namespace {

TEST(CgroupFiles, AreThoseOfTheGroupAndAllAroundIt) {
  using Files = std::vector<std::filesystem::path>;
  const CgroupLimit memory{"memory", "memory.max", "memory.limit_in_bytes"};
  EXPECT_EQ(cgroup_files("0::/user.slice/one.service", memory),
            (Files{"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/user.slice/memory.max",
                   "/sys/fs/cgroup/user.slice/one.service/memory.max"}));
  EXPECT_EQ(cgroup_files("0::/", memory), Files{"/sys/fs/cgroup/memory.max"});
  EXPECT_EQ(cgroup_files("4:cpu,memory:/a", memory),
            (Files{"/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/a/memory.limit_in_bytes"}));
  EXPECT_EQ(cgroup_files("4:cpu,memory2:/a", memory), Files{});
  EXPECT_EQ(cgroup_files("nonsense", memory), Files{});
}

TEST(AllowedCores, AreThoseOfTheScheduler) {
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  CPU_ZERO(&one);
  for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core) {
    if (CPU_ISSET(core, &before)) CPU_SET(core, &one);
  }
  EXPECT_LE(allowed_cores(), CPU_COUNT(&before));
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  EXPECT_EQ(allowed_cores(), 1) << "as under `taskset -c 0`";
  sched_setaffinity(0, sizeof(before), &before);
}

TEST(AllowedCores, OfAQuota) {
  EXPECT_EQ(cores_of_quota("150000 100000"), 1.5);
  EXPECT_EQ(cores_of_quota("max 100000"), std::nullopt);
  EXPECT_EQ(cores_of_quota("-1 100000"), std::nullopt) << "none, in version 1";
  EXPECT_EQ(cores_of_quota(""), std::nullopt);
}

}  // namespace
}  // namespace shaken
