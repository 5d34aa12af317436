// SPDX-License-Identifier: MIT
#include "server/log_slice.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

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
  write_text(file_, "ab\u20ac");
  for (const std::int64_t limit : {2, 3, 4}) EXPECT_EQ(read_slice(file_, 0, limit).text, "ab");
  EXPECT_EQ(read_slice(file_, 0, 5).text, "ab\u20ac");
  write_text(file_, "ab\U0001F600");
  for (const std::int64_t limit : {3, 4, 5}) EXPECT_EQ(read_slice(file_, 0, limit).text, "ab") << limit;
  EXPECT_EQ(read_slice(file_, 0, 6).text, "ab\U0001F600");
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

}  // namespace
}  // namespace shaken::server
