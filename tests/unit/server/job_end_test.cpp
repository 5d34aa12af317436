#include "server/job_end.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>

#include "run/files/progress.h"
#include "server/answers.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace job_end_test {

using enum JobEnd::Outcome;

class VerdictTest : public testing::Test {
 protected:
  JobEnd exit(int code) const { return judge({code, 0, 77}, false, "0123", run_); }
  JobEnd killed(int signal, bool stop_asked) const { return judge({0, signal, 77}, stop_asked, "0123", run_); }

  ScratchFolder directory_;
  run::RunDirectory run_{directory_.path()};
};

TEST_F(VerdictTest, ExitZeroNeedsASummary) {
  for (const char* text : {"", "{}", R"({"run_id": "0123", "exit": {"state": "stopped"}})",
                           R"({"run_id": "4567", "exit": {"state": "done"}})"}) {
    EXPECT_EQ(exit(0).outcome, kUnconfirmed) << text;
    write_text(run_.summary(), text);
  }
  EXPECT_EQ(exit(0).outcome, kUnconfirmed) << "the run of another scene";
  write_text(run_.summary(), R"({"run_id": "0123", "exit": {"state": "done"}})");
  EXPECT_EQ(exit(0).outcome, kDone);
  EXPECT_EQ(exit(0).reason, "");
}

TEST_F(VerdictTest, StopsAreTold) {
  EXPECT_EQ(exit(99).outcome, kStopped);
  EXPECT_EQ(killed(SIGTERM, false).outcome, kStopped);
  EXPECT_EQ(killed(SIGKILL, true).outcome, kStopped);
}

TEST_F(VerdictTest, OtherSignalsAndExitCodesAreCrashes) {
  EXPECT_EQ(killed(SIGKILL, false).outcome, kCrashed);
  EXPECT_EQ(killed(SIGSEGV, true).outcome, kCrashed);
  EXPECT_EQ(exit(127).outcome, kCrashed);
  EXPECT_EQ(exit(1).outcome, kFailed);
  EXPECT_EQ(exit(2).outcome, kFailed);
  EXPECT_EQ(killed(SIGSEGV, true).reason, "worker was killed by signal 11 (SIGSEGV)");
}

TEST_F(VerdictTest, AFullDiskIsNoFailureOfTheJob) {
  write_text(run_.log(), "checkpoint.bin.tmp: No space left on device\n");
  EXPECT_EQ(exit(97).outcome, kNoRoom);
  EXPECT_EQ(exit(97).reason, "checkpoint.bin.tmp: No space left on device");
  write_text(run_.log(), "2026-11-28T13:06:32.775 error cannot write a frame\n");
  EXPECT_EQ(exit(97).reason, "cannot write a frame") << "neither time nor level";
  write_text(run_.log(), "2026-11-28T13:06:32.775 frames cannot be written\n");
  EXPECT_EQ(exit(97).reason, "2026-11-28T13:06:32.775 frames cannot be written") << "no level";
}

// On a network's disk a read fails for once: the run goes on from its checkpoint.
TEST_F(VerdictTest, AnErrorOfTheSystemIsTriedAgain) {
  write_text(run_.log(), "2026-11-28T13:06:32.775 error cannot read trajectory.part: Stale file handle\n");
  EXPECT_EQ(exit(98).outcome, kCrashed);
  EXPECT_EQ(exit(98).reason, "exit 98: cannot read trajectory.part: Stale file handle");
}

TEST_F(VerdictTest, TheLastLineOfTheLogExplains) {
  EXPECT_EQ(exit(1).reason, "exit 1");
  write_text(run_.log(), std::string(kHeading) + "attempt 1\n");
  EXPECT_EQ(exit(1).reason, "exit 1");
  write_text(run_.log(), std::string(100'000, '.') + "\nfirst\nlast words\n \n\n");
  EXPECT_EQ(exit(1).reason, "exit 1: last words");
  EXPECT_EQ(exit(2).reason, "exit 2 (bad input): last words");
}

TEST_F(VerdictTest, APipeInPlaceOfTheLogKeepsNobody) {
  ASSERT_EQ(mkfifo(run_.log().c_str(), 0600), 0);
  EXPECT_EQ(exit(1).reason, "exit 1");
}

TEST_F(VerdictTest, OnlyTheProgressOfThisWorkerExplains) {
  write_text(run_.log(), "last words\n");
  run::Progress progress;
  progress.message = "rod 3 is not finite";
  progress.pid = 76;
  ASSERT_TRUE(run::write_progress(run_.progress(), progress));
  EXPECT_EQ(exit(1).reason, "exit 1: last words");
  progress.pid = 77;
  ASSERT_TRUE(run::write_progress(run_.progress(), progress));
  EXPECT_EQ(exit(1).reason, "exit 1: rod 3 is not finite");
}

class LogSliceTest : public testing::Test {
 protected:
  /// What a reader gets who asks for `limit` bytes at a time.
  std::string read_all(std::int64_t limit) const {
    std::string all;
    std::int64_t offset = 0;
    for (;;) {
      const LogSlice slice = read_slice(file_, offset, limit);
      EXPECT_EQ(slice.next, offset + static_cast<std::int64_t>(slice.text.size()));
      if (slice.text.empty()) return all;
      all += slice.text;
      offset = slice.next;
    }
  }
  ScratchFolder directory_;
  std::filesystem::path file_ = directory_ / "log";
};

TEST_F(LogSliceTest, SlicesAddUpToTheFile) {
  const std::string text = "angle \u03b8 = 0.5 \u20ac \U0001F600 end";
  write_text(file_, text);
  for (std::int64_t limit = 4; limit < 40; ++limit) EXPECT_EQ(read_all(limit), text) << limit;
}

TEST_F(LogSliceTest, NoSliceEndsInsideACharacter) {
  for (const std::string letter : {"\u03b8", "\u0e01", "\u20ac", "\U0001F600"}) {  // the first of all of its length too
    write_text(file_, "ab" + letter);
    const auto size = static_cast<std::int64_t>(2 + letter.size());
    for (std::int64_t limit = 2; limit < size; ++limit) EXPECT_EQ(read_slice(file_, 0, limit).text, "ab") << limit;
    EXPECT_EQ(read_slice(file_, 0, size).text, "ab" + letter);
  }
}

TEST_F(LogSliceTest, BytesThatAreNotTextDoNotStopTheReader) {
  const std::string text = "a\xFF\xC3\xC3 \xE2\x82";
  write_text(file_, text);
  EXPECT_EQ(read_all(4), text);
}

TEST_F(LogSliceTest, NothingBehindTheEndOrWithoutAFile) {
  EXPECT_EQ(read_slice(file_, 0, 10).text, "");
  write_text(file_, "abc");
  const LogSlice slice = read_slice(file_, 100, 10);
  EXPECT_EQ(slice.text, "");
  EXPECT_EQ(slice.next, 100);
}

TEST_F(LogSliceTest, APipeOfThatNameKeepsNobody) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_EQ(read_slice(file_, 0, 10).text, "");
}

}  // namespace job_end_test
}  // namespace shaken::server
