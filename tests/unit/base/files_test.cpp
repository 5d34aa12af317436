#include "base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <set>
#include <system_error>
#include <thread>
#include <vector>

#include "base/paths.h"
#include "base/scratch_folder.h"
#include "tests/support/good.h"
#include "tests/support/in_child.h"

namespace shaken {
namespace {

/// Names of what lies in `folder`, one after the other.
std::string listing(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : " ") + name;
  return all;
}

TEST(AtomicFile, ReplacesTheWholeContent) {
  const ScratchFolder folder;
  const auto file = folder / "state.json";
  EXPECT_TRUE(write_file_atomically(file, "a long first version"));
  EXPECT_TRUE(write_file_atomically(file, std::string("short\0with NUL", 14)));
  EXPECT_EQ(*read_file(file), std::string("short\0with NUL", 14));
  EXPECT_EQ(listing(folder.path()), "state.json");
}

TEST(AtomicFile, OfSeveralWritersOneHasItsContentThereWhole) {
  const ScratchFolder folder;
  const auto file = folder / "frames.xyz";
  std::atomic<int> failures = 0;
  std::vector<std::thread> writers;
  for (const char letter : {'a', 'b', 'c', 'd'}) {
    writers.emplace_back([&, letter] {
      for (int i = 0; i < 20; ++i) {
        auto next = ReplacementFile::create(file);
        bool good = static_cast<bool>(next);
        for (int piece = 0; good && piece < 50; ++piece)
          good = static_cast<bool>(next->append(std::string(1000, letter)));
        if (!good || !next->finish() || !write_file_atomically(file, std::string(50'000, letter))) ++failures;
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(failures, 0);
  const std::string content = *read_file(file);
  EXPECT_EQ(content, std::string(50'000, content.at(0)));
  EXPECT_EQ(listing(folder.path()), "frames.xyz");
}

TEST(AtomicFile, TakesTheLongestNameThatTheDiskDoes) {
  const ScratchFolder folder;
  const std::string name(255, 'n');
  const auto done = write_file_atomically(folder / name, "x");
  EXPECT_TRUE(done) << done.error().message;
  EXPECT_EQ(listing(folder.path()), name);
}

TEST(AtomicFile, WhatAKilledWriterLeftIsRemovedAndNothingElse) {
  const ScratchFolder folder;
  const auto file = folder / "state.json";
  for (const char* name : {"state.json", "state.json.0123456789ab.tmp", "state.json.0123456789aX.tmp", "state.json.tmp",
                           "other.json.0123456789ab.tmp", "state.json.0123456789ab"}) {
    ASSERT_TRUE(write_file(folder / name, "x"));
  }
  remove_unfinished(file);
  EXPECT_EQ(
      listing(folder.path()),
      "other.json.0123456789ab.tmp state.json state.json.0123456789aX.tmp state.json.0123456789ab state.json.tmp");
  remove_unfinished(folder / "no" / "folder");
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
  EXPECT_EQ(listing(folder.path()), "state.json");
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
}

TEST(UnfinishedFile, GoesWhereAnExceptionPasses) {
  const ScratchFolder folder;
  const auto write = [&] {
    UnfinishedFile unfinished(folder / "state.json");
    if (auto done = write_file(unfinished.path(), "half"); !done) return done;
    if (std::filesystem::exists(unfinished.path())) throw std::bad_alloc();
    return unfinished.replace();
  };
  EXPECT_THROW(static_cast<void>(write()), std::bad_alloc);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(UnfinishedFile, GoesWhereItCannotReplaceTheFile) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "state.json" / "in the way");
  EXPECT_FALSE(write_file_atomically(folder / "state.json", "new", Lasting::kNo));
  const std::filesystem::directory_iterator entries(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(ReplacementFile, TakesThePlaceOfTheOldContentOnlyAtItsEnd) {
  const ScratchFolder folder;
  const auto file = folder / "frames.xyz";
  ASSERT_TRUE(write_file_atomically(file, "old"));
  auto next = test::good(ReplacementFile::create(file));
  EXPECT_TRUE(next->append("first, "));
  EXPECT_TRUE(next->append("second"));
  EXPECT_EQ(*read_file(file), "old");
  EXPECT_TRUE(next->finish());
  EXPECT_EQ(*read_file(file), "first, second");
  EXPECT_EQ(listing(folder.path()), "frames.xyz");
}

TEST(ReplacementFile, GoesWithoutATraceWhenItIsNotFinished) {
  const ScratchFolder folder;
  const auto file = folder / "frames.xyz";
  ASSERT_TRUE(write_file_atomically(file, "old"));
  {
    auto next = test::good(ReplacementFile::create(file));
    EXPECT_TRUE(next->append("half"));
    EXPECT_NE(listing(folder.path()), "frames.xyz");
  }
  EXPECT_EQ(listing(folder.path()), "frames.xyz");
  EXPECT_EQ(*read_file(file), "old");
}

TEST(ReplacementFile, SaysWhichFileCannotBeWritten) {
  const ScratchFolder folder;
  EXPECT_THAT(test::refusal(ReplacementFile::create(folder / "missing" / "frames.xyz")),
              testing::HasSubstr("missing/frames.xyz"));
  const int failures = in_child([&] {
    limit_file_size(1000);
    auto next = ReplacementFile::create(folder / "frames.xyz");
    const auto done = next->append(std::string(100000, 'x'));
    return !done && done.error().message.find("frames.xyz") != std::string::npos;
  });
  EXPECT_EQ(failures, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "frames.xyz"));
}

TEST(ReadPart, IsWhatIsThereOfIt) {
  const ScratchFolder folder;
  const auto file = folder / "file";
  ASSERT_TRUE(write_file(file, "0123456789"));
  EXPECT_EQ(*read_part(file, 0, 4), "0123");
  EXPECT_EQ(*read_part(file, 8, 4), "89");
  errno = EINTR;  // of an earlier call
  EXPECT_EQ(*read_part(file, 20, 4), "");
  EXPECT_EQ(*read_part(file, -3, 100), "789");
  EXPECT_EQ(*read_part(file, -30, 2), "01");
  EXPECT_FALSE(read_part(folder.path(), 0, 1));
  EXPECT_FALSE(read_part("/dev/zero", 0, 1));
}

TEST(FileAsOpened, IsGoneWhenItIsRemovedReplacedOrMovedWithItsFolder) {
  const ScratchFolder folder;
  const auto in = folder / "in";
  const auto opened = [&] {
    EXPECT_TRUE(make_folder(in));
    EXPECT_TRUE(write_file(in / "file", "1"));
    return FileAsOpened(in / "file");
  };
  const FileAsOpened stays = opened();
  EXPECT_TRUE(write_file(in / "file", "22")) << "other content in the same file";
  EXPECT_FALSE(stays.is_gone());
  EXPECT_TRUE(write_file_atomically(in / "file", "1"));
  EXPECT_TRUE(stays.is_gone());
  const FileAsOpened removed = opened(), moved = opened();
  std::filesystem::rename(in, folder / "elsewhere");
  EXPECT_TRUE(moved.is_gone());
  EXPECT_TRUE(removed.is_gone());
}

TEST(ScratchFolder, IsWhereTmpdirSaysWhichIsNamedWhereItIsOfNoUse) {
  setenv("TMPDIR", "", 1);
  EXPECT_EQ(ScratchFolder().path().parent_path(), "/tmp") << "empty is as if it were not set";
  setenv("TMPDIR", "/nonexistent", 1);
  EXPECT_THAT([] { ScratchFolder(); },
              testing::ThrowsMessage<std::system_error>(
                  "no folder can be made in /nonexistent, which TMPDIR names: No such file or directory"));
  unsetenv("TMPDIR");
}

TEST(AtomicFile, MissingFileCannotBeRead) {
  const ScratchFolder folder;
  EXPECT_THAT(test::refusal(read_file(folder / "nothing")), testing::HasSubstr("nothing"));
}

TEST(DataRoot, WhatIsGivenDecidesElseTheFirstVariableThatIsSet) {
  for (const char* name : {"SHAKEN_ROOT", "XDG_DATA_HOME", "HOME"}) unsetenv(name);
  EXPECT_EQ(test::refusal(data_root()), "no root directory: set --root, SHAKEN_ROOT, or HOME to an absolute path");
  setenv("HOME", "/h", 1);
  EXPECT_EQ(*data_root(), "/h/.local/share/shaken");
  setenv("XDG_DATA_HOME", "/x", 1);
  EXPECT_EQ(*data_root(), "/x/shaken");
  setenv("SHAKEN_ROOT", "/s", 1);
  EXPECT_EQ(*data_root(), "/s");
  EXPECT_EQ(*data_root("/g"), "/g");
  EXPECT_EQ(*data_root("g"), std::filesystem::current_path() / "g");
}

// It would be another root in every folder.
TEST(DataRoot, ARelativePathInTheEnvironmentIsIgnored) {
  unsetenv("SHAKEN_ROOT");
  setenv("XDG_DATA_HOME", "rel", 1);
  setenv("HOME", "/h", 1);
  EXPECT_EQ(*data_root(), "/h/.local/share/shaken");
  setenv("HOME", "rel", 1);
  EXPECT_FALSE(data_root());
}

// Verbs that open a run's folder got its name through JSON, with U+FFFD in the place of such a byte.
TEST(DataRoot, ANameThatJsonCannotHaveIsRefused) {
  for (const char* name : {"/tmp/r\xff", "/tmp/a\nb"}) {
    EXPECT_THAT(test::refusal(data_root(name)), testing::HasSubstr("UTF-8 without control characters, not /tmp/"));
  }
  EXPECT_EQ(*data_root("/tmp/\u03bc \u00e4"), "/tmp/\u03bc \u00e4");
}

}  // namespace
}  // namespace shaken
