// SPDX-License-Identifier: MIT
#include "base/files.h"

#include <gtest/gtest.h>

#include "base/scratch_folder.h"
#include "tests/support/in_child.h"

namespace shaken {
namespace {

TEST(AtomicFile, ReplacesTheWholeContent) {
  const ScratchFolder folder;
  const auto file = folder / "state.json";
  EXPECT_TRUE(write_file_atomically(file, "a long first version"));
  EXPECT_TRUE(write_file_atomically(file, std::string("short\0with NUL", 14)));
  EXPECT_EQ(*read_file(file), std::string("short\0with NUL", 14));
  EXPECT_FALSE(std::filesystem::exists(temporary_for(file)));
}

TEST(AtomicFile, SaysWhichFileCannotBeWritten) {
  const ScratchFolder folder;
  const auto done = write_file_atomically(folder / "missing" / "state.json", "x");
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("missing/state.json"), std::string::npos) << done.error().message;
  EXPECT_NE(done.error().message.find("No such file"), std::string::npos) << done.error().message;
}

TEST(AtomicFile, RefusesToReplaceAFolderAndLeavesNothingBehind) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "state.json" / "inside");
  EXPECT_FALSE(write_file_atomically(folder / "state.json", "x"));
  EXPECT_FALSE(std::filesystem::exists(folder / "state.json.tmp"));
}

TEST(AtomicFile, FullDiskKeepsTheOldContent) {
  const ScratchFolder folder;
  const auto file = folder / "state.json";
  ASSERT_TRUE(write_file_atomically(file, "old"));
  const int failures = in_child([&] {
    limit_file_size(1000);
    const auto done = write_file_atomically(file, std::string(100000, 'x'));
    return !done && done.error().message.find("state.json") != std::string::npos;
  });
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(*read_file(file), "old");
  EXPECT_FALSE(std::filesystem::exists(temporary_for(file)));
}

TEST(ReplacementFile, TakesThePlaceOfTheOldContentOnlyAtItsEnd) {
  const ScratchFolder folder;
  const auto file = folder / "frames.xyz";
  ASSERT_TRUE(write_file_atomically(file, "old"));
  auto next = ReplacementFile::create(file);
  ASSERT_TRUE(next) << next.error().message;
  EXPECT_TRUE(next->append("first, "));
  EXPECT_TRUE(next->append("second"));
  EXPECT_EQ(*read_file(file), "old");
  EXPECT_TRUE(next->finish());
  EXPECT_EQ(*read_file(file), "first, second");
  EXPECT_FALSE(std::filesystem::exists(temporary_for(file)));
}

TEST(ReplacementFile, GoesWithoutATraceWhenItIsNotFinished) {
  const ScratchFolder folder;
  const auto file = folder / "frames.xyz";
  ASSERT_TRUE(write_file_atomically(file, "old"));
  {
    auto next = ReplacementFile::create(file);
    ASSERT_TRUE(next) << next.error().message;
    EXPECT_TRUE(next->append("half"));
    EXPECT_TRUE(std::filesystem::exists(temporary_for(file)));
  }
  EXPECT_FALSE(std::filesystem::exists(temporary_for(file)));
  EXPECT_EQ(*read_file(file), "old");
}

TEST(ReplacementFile, SaysWhichFileCannotBeWritten) {
  const ScratchFolder folder;
  const auto nowhere = ReplacementFile::create(folder / "missing" / "frames.xyz");
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("missing/frames.xyz"), std::string::npos) << nowhere.error().message;
  const int failures = in_child([&] {
    limit_file_size(1000);
    auto next = ReplacementFile::create(folder / "frames.xyz");
    const auto done = next->append(std::string(100000, 'x'));
    return !done && done.error().message.find("frames.xyz") != std::string::npos;
  });
  EXPECT_EQ(failures, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "frames.xyz"));
  EXPECT_FALSE(std::filesystem::exists(folder / "frames.xyz.tmp"));
}

TEST(AtomicFile, MissingFileCannotBeRead) {
  const ScratchFolder folder;
  const auto content = read_file(folder / "nothing");
  ASSERT_FALSE(content);
  EXPECT_NE(content.error().message.find("nothing"), std::string::npos);
}

}  // namespace
}  // namespace shaken
