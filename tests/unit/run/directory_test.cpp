// SPDX-License-Identifier: MIT
#include "run/files/directory.h"

#include <gtest/gtest.h>

#include "base/scratch_folder.h"
#include "tests/support/in_child.h"

namespace shaken::run {
namespace {

TEST(DirectoryLock, KeepsOtherProcessesOutAndNamesTheOwner) {
  const ScratchFolder folder;
  const auto lock = DirectoryLock::acquire(folder / "lock");
  ASSERT_TRUE(lock);
  const std::string owner = "process " + std::to_string(getpid());
  EXPECT_EQ(in_child([&] {
              const auto second = DirectoryLock::acquire(folder / "lock");
              return !second && second.error().message.find(owner) != std::string::npos;
            }),
            0);
}

TEST(DirectoryLock, IsNeverStale) {
  const ScratchFolder folder;
  // The child dies holding the lock.
  EXPECT_EQ(in_child([&] {
              auto lock = DirectoryLock::acquire(folder / "lock");
              _exit(lock ? 0 : 1);
              return false;
            }),
            0);
  EXPECT_TRUE(DirectoryLock::acquire(folder / "lock"));
}

TEST(DirectoryLock, EndsWithItsObject) {
  const ScratchFolder folder;
  {
    auto lock = DirectoryLock::acquire(folder / "lock");
    ASSERT_TRUE(lock);
    const DirectoryLock moved = std::move(lock).value();
    EXPECT_FALSE(DirectoryLock::acquire(folder / "lock"));
  }
  EXPECT_TRUE(DirectoryLock::acquire(folder / "lock"));
}

TEST(DirectoryLock, IsNotInheritedByPrograms) {
  const ScratchFolder folder;
  pid_t child = -1;
  {
    const auto lock = DirectoryLock::acquire(folder / "lock");
    ASSERT_TRUE(lock);
    child = fork();
    if (child == 0) {
      execlp("sleep", "sleep", "30", nullptr);
      _exit(127);
    }
    // Between fork and exec the child still shares the lock.
    const std::string comm = "/proc/" + std::to_string(child) + "/exe";
    while (std::filesystem::read_symlink(comm) == std::filesystem::read_symlink("/proc/self/exe")) usleep(1000);
  }
  EXPECT_TRUE(DirectoryLock::acquire(folder / "lock"));
  kill(child, SIGTERM);
  waitpid(child, nullptr, 0);
}

TEST(DirectoryLock, IsHeldWhileItLives) {
  const ScratchFolder folder;
  EXPECT_FALSE(DirectoryLock::is_held(folder / "lock")) << "there is none";
  {
    const auto lock = DirectoryLock::acquire(folder / "lock");
    ASSERT_TRUE(static_cast<bool>(lock));
    EXPECT_TRUE(DirectoryLock::is_held(folder / "lock"));
  }
  EXPECT_FALSE(DirectoryLock::is_held(folder / "lock"));
}

}  // namespace
}  // namespace shaken::run
