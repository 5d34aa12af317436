#include "run/files/checkpoint_file.h"

#include <gtest/gtest.h>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "tests/support/in_child.h"

namespace shaken::run {
namespace {

constexpr const char* kRun = "0123456789abcdef";

std::vector<std::byte> bytes(std::size_t n, int first) {
  std::vector<std::byte> result(n);
  for (std::size_t i = 0; i < n; ++i)
    result[i] = static_cast<std::byte>((static_cast<std::size_t>(first) + 7 * i) & 255);
  return result;
}

Checkpoint example(int first = 1) { return {bytes(300, first), bytes(60, first + 1), 12.5, 20.25}; }

void expect_same(const Checkpoint& a, const Checkpoint& b) {
  EXPECT_EQ(a.simulation, b.simulation);
  EXPECT_EQ(a.measurements, b.measurements);
  EXPECT_EQ(a.cpu_seconds, b.cpu_seconds);
  EXPECT_EQ(a.wall_seconds, b.wall_seconds);
}

TEST(CheckpointFile, ComesBackExactlyAndKeepsItsPredecessor) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  ASSERT_TRUE(write_checkpoint(directory, kRun, example(1)));
  EXPECT_FALSE(std::filesystem::exists(directory.previous_checkpoint()));
  ASSERT_TRUE(write_checkpoint(directory, kRun, example(2)));
  ASSERT_TRUE(write_checkpoint(directory, kRun, example(3)));
  expect_same(*read_checkpoint(directory.checkpoint(), kRun), example(3));
  expect_same(*read_checkpoint(directory.previous_checkpoint(), kRun), example(2));
}

TEST(CheckpointFile, EmptyPartsAreFine) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_checkpoint({folder.path()}, kRun, Checkpoint{}));
  expect_same(*read_checkpoint(RunDirectory{folder.path()}.checkpoint(), kRun), Checkpoint{});
}

class DamagedCheckpoint : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_checkpoint({folder_.path()}, kRun, example()));
    content_ = *read_file(file_);
  }
  bool refused(const std::string& content) const {
    EXPECT_TRUE(write_file(file_, content));
    const auto read = read_checkpoint(file_, kRun);
    if (!read) {
      EXPECT_NE(read.error().message.find("checkpoint.bin"), std::string::npos);
    }
    return !read;
  }
  ScratchFolder folder_;
  std::filesystem::path file_ = RunDirectory{folder_.path()}.checkpoint();
  std::string content_;
};

TEST_F(DamagedCheckpoint, IsRefusedWhereverItIsCut) {
  for (std::size_t size = 0; size < content_.size(); ++size) EXPECT_TRUE(refused(content_.substr(0, size))) << size;
}

TEST_F(DamagedCheckpoint, IsRefusedWhicheverByteIsChanged) {
  for (std::size_t at = 0; at < content_.size(); ++at) {
    std::string damaged = content_;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    EXPECT_TRUE(refused(damaged)) << at;
  }
}

TEST_F(DamagedCheckpoint, IsRefusedWithSomethingBehind) {
  EXPECT_TRUE(refused(content_ + '\0'));
  EXPECT_FALSE(refused(content_)) << "and only then";
}

TEST(CheckpointFile, OfAnotherRunIsRefusedByName) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  ASSERT_TRUE(write_checkpoint(directory, "fedcba9876543210", example()));
  const auto read = read_checkpoint(directory.checkpoint(), kRun);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("fedcba9876543210"), std::string::npos) << read.error().message;
}

TEST(CheckpointFile, FullDiskLeavesBothPredecessors) {
  const ScratchFolder folder;
  const RunDirectory directory{folder.path()};
  ASSERT_TRUE(write_checkpoint(directory, kRun, example(1)));
  ASSERT_TRUE(write_checkpoint(directory, kRun, example(2)));
  EXPECT_EQ(in_child([&] {
              limit_file_size(100);
              return !write_checkpoint(directory, kRun, example(3));
            }),
            0);
  expect_same(*read_checkpoint(directory.checkpoint(), kRun), example(2));
  expect_same(*read_checkpoint(directory.previous_checkpoint(), kRun), example(1));
}

}  // namespace
}  // namespace shaken::run
