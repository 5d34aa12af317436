// SPDX-License-Identifier: MIT
#include "base/files.h"

#include <gtest/gtest.h>

#include "tests/unit/run/temporary_folder.h"

namespace shaken {
namespace {

using run::in_child, run::limit_file_size, run::TemporaryFolder;

TEST(AtomicFile, ReplacesTheWholeContent) {
  const TemporaryFolder folder;
  const auto file = folder / "state.json";
  EXPECT_TRUE(write_file_atomically(file, "a long first version"));
  EXPECT_TRUE(write_file_atomically(file, std::string("short\0with NUL", 14)));
  EXPECT_EQ(*read_file(file), std::string("short\0with NUL", 14));
  EXPECT_FALSE(std::filesystem::exists(temporary_for(file)));
}

TEST(AtomicFile, SaysWhichFileCannotBeWritten) {
  const TemporaryFolder folder;
  const auto done = write_file_atomically(folder / "missing" / "state.json", "x");
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("missing/state.json"), std::string::npos) << done.error().message;
  EXPECT_NE(done.error().message.find("No such file"), std::string::npos) << done.error().message;
}

TEST(AtomicFile, RefusesToReplaceAFolderAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "state.json" / "inside");
  EXPECT_FALSE(write_file_atomically(folder / "state.json", "x"));
  EXPECT_FALSE(std::filesystem::exists(folder / "state.json.tmp"));
}

TEST(AtomicFile, FullDiskKeepsTheOldContent) {
  const TemporaryFolder folder;
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

TEST(AtomicFile, MissingFileCannotBeRead) {
  const TemporaryFolder folder;
  const auto content = read_file(folder / "nothing");
  ASSERT_FALSE(content);
  EXPECT_NE(content.error().message.find("nothing"), std::string::npos);
}

}  // namespace
}  // namespace shaken
