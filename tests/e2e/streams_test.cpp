// Programs whose standard streams are closed, or cannot be written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "base/files.h"
#include "tests/e2e/run_command.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace streams_test {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

constexpr const char* kScene = R"({
  "rods": { "count": 4, "length": "2.5 mm", "beads": 7 }, "box": { "side": "12 mm" },
  "time": { "step": "20 us", "measure": "2 ms", "steady": "1 ms" }, "trajectory": { "every": "1 ms" }
})";

Finished shell(const std::string& words) { return run_command({"/bin/sh", "-c", words}); }

TEST(Streams, WhatCannotBeWrittenToStandardOutputIsAnError) {
  for (const std::string name : {"shaken", "shakend", "shaken-worker", "shaken-render", "shaken-task", "shaken-web"}) {
    const Finished full = shell(program(name) + " --version > /dev/full");
    EXPECT_EQ(full.code, 1) << name;
    EXPECT_THAT(full.output, StartsWith(name + ": cannot write to standard output"));
    EXPECT_EQ(said_with(0, shell(program(name) + " --version > /dev/null")), "") << name;
    EXPECT_EQ(shell(program(name) + " --no-such-option > /dev/full").code, 2) << name;
  }
}

TEST(Streams, AReaderThatHasGoneIsNotWorthAWord) {
  const Finished gone = shell("{ sleep 0.2; " + program("shaken") + " schema; } | true");
  EXPECT_EQ(gone.output, "");
}

// A log line that is meant for a closed stream must not go into the file that is opened next.
TEST(Streams, LockFilesHoldThePidAndNothingElseWhereStreamsAreClosed) {
  const ScratchFolder folder;
  const auto scene = folder / "scene.json";
  ASSERT_TRUE(write_file(scene, kScene));
  for (const std::string closed : {"2>&-", ">&- 2>&-", "<&- >&- 2>&-"}) {
    const auto out = folder / ("run" + std::to_string(closed.size()));
    EXPECT_EQ(
        shell(program("shaken-worker") + " " + scene.string() + " --out " + out.string() + " --no-lcm " + closed).code,
        0);
    const auto lock = read_file(out / "lock");
    ASSERT_TRUE(lock) << lock.error().message;
    EXPECT_THAT(*lock, MatchesRegex("[0-9]+\n?")) << closed;
  }
  // The daemon says that it is ready, and stops when it is asked to.
  const auto root = folder / "root";
  const Finished daemon =
      shell("cd " + folder.path().string() + "; " + program("shakend") + " --root " + root.string() +
            " --no-lcm <&- >&- 2>&- & pid=$!; i=0; while [ ! -S root/shakend.sock ] && [ $i -lt 200 "
            "]; do sleep 0.1; i=$((i+1)); done; sleep 0.2; echo pid $pid; cat root/shakend.lock; kill "
            "$pid; wait $pid; echo code $?");
  EXPECT_THAT(daemon.output, MatchesRegex("pid ([0-9]+)\n[0-9]+\n?code 0\n")) << daemon.output;
}

// ulimit -f, and what batch systems make of it.
TEST(Streams, AFileBeyondTheLimitOfItsUserIsAnErrorWithWords) {
  const ScratchFolder folder;
  const auto scene = folder / "scene.json";
  ASSERT_TRUE(write_file(scene, kScene));
  EXPECT_THAT(said_with(1, shell("ulimit -f 2; exec " + program("shaken-worker") + " " + scene.string() + " --out " +
                                 (folder / "run").string() + " --no-lcm")),
              HasSubstr("File too large"));
}

// A device or a pipe has no end.
TEST(Streams, ASceneThatDoesNotEndIsRefused) {
  const ScratchFolder folder;
  for (const std::string& command :
       {program("shaken") + " validate /dev/zero", program("shaken") + " validate - < /dev/zero",
        program("shaken-worker") + " /dev/zero --out " + (folder / "run").string()}) {
    EXPECT_THAT(said_with(2, shell("timeout -k 5 60 " + command)),
                HasSubstr("is longer than 16 MiB, the most that is read of it"))
        << command;
  }
  // A pipe that says nothing does not keep the worker from being stopped.
  const Finished stopped = shell("mkfifo " + (folder / "pipe").string() + "; exec 3<>" + (folder / "pipe").string() +
                                 "; timeout -k 20 1 " + program("shaken-worker") + " " + (folder / "pipe").string() +
                                 " --out " + (folder / "run").string() + "; echo code $?");
  EXPECT_THAT(stopped.output, HasSubstr("code 124")) << "137 if only SIGKILL did";
}

}  // namespace streams_test
}  // namespace shaken::test
