#include "base/process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "base/core/cgroup.h"
#include "base/descriptor.h"
#include "base/memory.h"
#include "base/processor.h"

namespace shaken {
namespace {

TEST(RunCaptured, GivesWhatWasWrittenAndTheCode) {
  const Captured result = run_captured({"sh", "-c", "echo out; echo err >&2; exit 3"});
  EXPECT_EQ(result.output, "out\nerr\n");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(run_captured({"sh", "-c", "kill -9 $$"}).exit_code, 128 + SIGKILL);
}

TEST(RunCaptured, TellsWhyAProgramCannotBeRun) {
  const Captured missing = run_captured({"/nowhere/at-all"});
  EXPECT_EQ(missing.exit_code, 127);
  EXPECT_EQ(missing.output, "/nowhere/at-all cannot be run: No such file or directory");
  EXPECT_EQ(run_captured({"true"}, "/nowhere").output, "true cannot be run: No such file or directory");
}

TEST(RunWithInput, TheProgramReadsIt) {
  EXPECT_EQ(run_with_input({"cat"}, "a line\nand one without its end").output, "a line\nand one without its end");
  EXPECT_EQ(run_with_input({"cat"}, "").output, "");
  const std::string much(3'000'000, 'x');  // more than a pipe holds
  EXPECT_EQ(run_with_input({"wc", "-c"}, much).output, "3000000\n");
  EXPECT_EQ(run_with_input({"true"}, much).exit_code, 0) << "nobody has to read it";
}

TEST(RunCaptured, RunsInTheFolder) { EXPECT_EQ(run_captured({"pwd", "-P"}, "/").output, "/\n"); }

// A program that hangs, and what it has started, must not keep whoever asked it.
TEST(RunCaptured, KillsWhatGoesBeyondItsLimits) {
  using std::chrono::hours;
  const Captured late = run_captured({"sh", "-c", "echo begun; sleep 3600 & sleep 3600"},
                                     CaptureLimits{.time = std::chrono::milliseconds(300)});
  EXPECT_TRUE(late.cut_short);
  EXPECT_EQ(late.exit_code, 128 + SIGKILL);
  const Captured stopped = run_captured({"sh", "-c", "kill -STOP $$"}, CaptureLimits{std::chrono::milliseconds(100)});
  EXPECT_TRUE(stopped.cut_short);
  const Captured wordy = run_captured({"yes"}, CaptureLimits{.time = hours(1), .output = 100'000});
  EXPECT_TRUE(wordy.cut_short);
  EXPECT_LT(wordy.output.size(), 1'000'000u);
  const Captured unwanted =
      run_captured({"sleep", "3600"}, CaptureLimits{.time = hours(1), .stop = [] { return true; }});
  EXPECT_TRUE(unwanted.cut_short);
  const Captured within = run_captured({"echo", "done"}, CaptureLimits{.time = hours(1), .output = 100});
  EXPECT_FALSE(within.cut_short);
  EXPECT_EQ(within.output, "done\n");
}

TEST(RunCaptured, EndsWithUsEvenIfWeAreKilled) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t us = fork();
  if (us == 0) {
    run_captured(
        {"sh", "-c",
         "echo $$ > /proc/" + std::to_string(getppid()) + "/fd/" + std::to_string(ends[1]) + "; exec sleep 60"});
    _exit(0);
  }
  char text[32] = {};
  ASSERT_GT(read(ends[0], text, sizeof text - 1), 0);
  const pid_t child = std::stoi(text);
  kill(us, SIGKILL);
  wait_for_child(us);
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  // Gone, or a zombie that nobody has reaped yet.
  const auto is_alive = [&] {
    std::string line;
    std::getline(std::ifstream("/proc/" + std::to_string(child) + "/stat"), line);
    return !line.empty() && line.find(") Z ") == std::string::npos;
  };
  while (is_alive() && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_FALSE(is_alive());
  if (is_alive()) kill(child, SIGKILL);
  close(ends[0]);
  close(ends[1]);
}

// A child that waited for our terminal would never end, and one that kept our descriptors would hold their locks.
TEST(StartChild, HasAnEmptyStdinAndNoDescriptorOfOurs) {
  const Descriptor open_here(open("/dev/zero", O_RDONLY));  // without O_CLOEXEC, as libraries open theirs
  EXPECT_EQ(run_captured({"sh", "-c", "cat | wc -c"}).output, "0\n");
  const std::string ours = "/proc/self/fd/" + std::to_string(open_here.value());
  EXPECT_NE(run_captured({"sh", "-c", "test -e " + ours}).exit_code, 0);
}

TEST(StartChild, GivesBackTheSignalsThatWeIgnoreOrBlock) {
  sigset_t pipe, before;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  sigprocmask(SIG_BLOCK, &pipe, &before);
  const auto old = std::signal(SIGPIPE, SIG_IGN);
  EXPECT_EQ(run_captured({"sh", "-c", "kill -PIPE $$; echo alive"}).exit_code, 128 + SIGPIPE);
  std::signal(SIGPIPE, old);
  sigprocmask(SIG_SETMASK, &before, nullptr);
}

TEST(StartChild, OfItsOwnGroupIsOutOfReachOfACtrlC) {
  const Result<pid_t> child = start_child({.command = {"sleep", "60"}, .own_group = true});
  ASSERT_TRUE(child);
  EXPECT_EQ(getpgid(*child), *child);
  EXPECT_FALSE(poll_child(*child));
  kill(*child, SIGTERM);
  EXPECT_EQ(wait_for_child(*child).signal, SIGTERM);
}

TEST(StartChild, EndsWithTheThreadThatStartedIt) {
  pid_t child = 0;
  std::thread([&] { child = start_child({.command = {"sleep", "60"}, .ends_with_us = true}).value(); }).join();
  EXPECT_EQ(wait_for_child(child).signal, SIGTERM);
}

TEST(ProcessEnd, InWords) {
  EXPECT_EQ((ProcessEnd{3, 0}.text()), "failed with exit code 3");
  EXPECT_EQ((ProcessEnd{0, 9}.text()), "was ended by signal 9");
  EXPECT_EQ((ProcessEnd{0, 9}.shell_code()), 137);
  EXPECT_TRUE((ProcessEnd{0, 0}.is_success()));
}

TEST(PeakMemory, IsWhatWasHeldAtMost) {
  constexpr std::size_t kMuch = 80'000'000;
  const double before = peak_memory();
  EXPECT_GT(before, 1e5);
  {
    const std::string much(kMuch, 'x');
    EXPECT_EQ(much.back(), 'x');
  }
  const double after = peak_memory();
  EXPECT_GT(after, kMuch) << "though it has been given back";
  EXPECT_EQ(run_captured({"true"}).exit_code, 0);
  EXPECT_GT(children_peak_memory(), 1e5);
  EXPECT_LT(peak_memory(), after + kMuch) << "a child holds its own";
}

// What the scheduler and its groups give to a process.

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
