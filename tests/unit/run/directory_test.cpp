#include "run/files/directory.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/files/content_hash.h"
#include "run/files/observables_file.h"
#include "run/files/progress.h"
#include "run/files/trajectory.h"
#include "tests/support/damaged_hdf5.h"
#include "tests/support/good.h"
#include "tests/support/in_child.h"

namespace shaken::run {
namespace {

TEST(DirectoryLock, KeepsOtherProcessesOutAndNamesTheOwner) {
  const ScratchFolder folder;
  const auto lock = test::good(DirectoryLock::acquire(folder / "lock"));
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
    auto lock = test::good(DirectoryLock::acquire(folder / "lock"));
    const DirectoryLock moved = std::move(lock).value();
    EXPECT_FALSE(DirectoryLock::acquire(folder / "lock"));
  }
  EXPECT_TRUE(DirectoryLock::acquire(folder / "lock"));
}

TEST(DirectoryLock, IsNotInheritedByPrograms) {
  const ScratchFolder folder;
  pid_t child = -1;
  {
    const auto lock = test::good(DirectoryLock::acquire(folder / "lock"));
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
    const auto lock = test::good(DirectoryLock::acquire(folder / "lock"));
    EXPECT_TRUE(DirectoryLock::is_held(folder / "lock"));
  }
  EXPECT_FALSE(DirectoryLock::is_held(folder / "lock"));
}

class ContentHashTest : public testing::Test {
 protected:
  ContentHashTest() { EXPECT_TRUE(write_observables(file_, {{"/order/order", {0.5, 0.25}}})); }
  /// A summary with the hash of the file as it is now.
  void summarize() const {
    const ContentHash hash = content_hash(file_).value();
    ASSERT_TRUE(write_file(
        directory_.summary(),
        fmt::format(R"({{"files": {{"observables.h5": {{"bytes": {}, "xxh3": "{:016x}"}}}}}})", hash.size, hash.xxh3)));
  }
  /// Changes one byte of a number, which HDF5 does not notice.
  void damage() const {
    std::string bytes = read_file(file_).value();
    const double half = 0.5;
    const std::size_t place = bytes.find(std::string(reinterpret_cast<const char*>(&half), sizeof(half)));
    ASSERT_NE(place, std::string::npos);
    bytes[place + 6] ^= 1;
    std::ofstream(file_, std::ios::binary) << bytes;
  }

  ScratchFolder folder_;
  RunDirectory directory_{folder_.path()};
  std::filesystem::path file_ = directory_.observables();
};

TEST_F(ContentHashTest, IsThatOfTheBytes) {
  ASSERT_TRUE(write_file(folder_ / "empty", ""));
  EXPECT_EQ(content_hash(folder_ / "empty").value(), (ContentHash{0, 0x2d06800538d394c2}));  // XXH3 of nothing
  EXPECT_FALSE(content_hash(folder_ / "nothing"));
  EXPECT_FALSE(content_hash(folder_.path()));
  EXPECT_EQ(content_hash(file_).value().size, std::filesystem::file_size(file_));
}

TEST_F(ContentHashTest, DamageThatHdf5DoesNotSeeIsFound) {
  summarize();
  EXPECT_TRUE(read_observables(file_));
  damage();
  const auto read = read_observables(file_);
  ASSERT_FALSE(read) << "it was read as " << read->at("/order/order").front();
  EXPECT_THAT(read.error().message, testing::HasSubstr(file_.string() + " is damaged"));
  EXPECT_THAT(read.error().message, testing::HasSubstr("submit the scene again"));
}

TEST_F(ContentHashTest, DamageThatHdf5DoesNotSurviveIsFoundBefore) {
  summarize();
  ASSERT_TRUE(make_endless(file_));
  EXPECT_FALSE(read_observables(file_));
  std::filesystem::copy_file(file_, directory_.trajectory());
  std::string summary = read_file(directory_.summary()).value();
  summary.replace(summary.find("observables"), 11, "trajectory");
  ASSERT_TRUE(write_file(directory_.summary(), summary));
  EXPECT_THAT(TrajectoryReader::open(directory_.trajectory()).error().message, testing::HasSubstr("is damaged"));
}

TEST_F(ContentHashTest, WithoutAHashNothingIsKnown) {
  damage();
  EXPECT_TRUE(read_observables(file_)) << "there is no summary";
  for (const char* summary : {"{}", "no JSON", "[]", R"({"files": 7})", R"({"files": {"observables.h5": {}}})",
                              R"({"files": {"observables.h5": {"bytes": -1, "xxh3": 7}}})"}) {
    ASSERT_TRUE(write_file(directory_.summary(), summary));
    EXPECT_TRUE(read_observables(file_)) << summary;
  }
}

// A worker that makes a run longer replaces observables.h5 first and summary.json last.
TEST_F(ContentHashTest, ARunThatGoesOnHasNewFilesBeforeItsNewSummary) {
  summarize();
  damage();
  Progress progress;
  ASSERT_TRUE(write_progress(directory_.progress(), progress));
  EXPECT_TRUE(read_observables(file_));
  progress.state = "done";
  ASSERT_TRUE(write_progress(directory_.progress(), progress));
  EXPECT_FALSE(read_observables(file_));
}

// Only to be told apart by what reading it would cost: the hash in the summary is made wrong.
TEST_F(ContentHashTest, AFileThatWasFoundWholeIsNotReadAgain) {
  summarize();
  EXPECT_TRUE(check_content(file_));
  ASSERT_TRUE(write_file(directory_.summary(), R"({"files": {"observables.h5": {"bytes": 1, "xxh3": "0"}}})"));
  EXPECT_TRUE(check_content(file_));
  std::filesystem::last_write_time(file_, std::filesystem::last_write_time(file_) + std::chrono::seconds(1));
  EXPECT_FALSE(check_content(file_));
  assume_whole(file_);
  EXPECT_TRUE(check_content(file_));
}

}  // namespace
}  // namespace shaken::run
