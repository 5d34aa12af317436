// LCM's log files: ours read by liblcm and the other way round, cut and damaged ones, and a disk that is full.
#include "proto/log_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "proto/channels.h"
#include "proto/codec.h"
#include "tests/contract/samples.h"
#include "tests/support/good.h"

namespace shaken::proto {
namespace {

class LogFile : public testing::Test {
 protected:
  LogFile() : file_(std::filesystem::temp_directory_path() / ("shaken_log_" + std::to_string(getpid()))) {}
  ~LogFile() override { std::filesystem::remove(file_); }

  /// Ten messages, a second apart; the n-th on channel "C" with n bytes.
  void write_ten() const {
    LogWriter log = LogWriter::create(file_).value();
    for (std::uint8_t n = 0; n < 10; ++n) {
      ASSERT_TRUE(log.write(1'000'000 * n + 5'000'000, "C", std::vector<std::uint8_t>(n, n)));
    }
    EXPECT_EQ(log.messages(), 10);
    EXPECT_EQ(log.bytes(), static_cast<std::int64_t>(std::filesystem::file_size(file_)));
    EXPECT_TRUE(log.finish());
  }
  std::string content() const {
    std::stringstream text;
    text << std::ifstream(file_, std::ios::binary).rdbuf();
    return text.str();
  }
  void put(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }

  std::filesystem::path file_;
};

TEST_F(LogFile, LiblcmReadsWhatIsWritten) {
  write_ten();
  lcm_eventlog_t* log = lcm_eventlog_create(file_.c_str(), "r");
  for (int n = 0; n < 10; ++n) {
    lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log);
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, n);
    EXPECT_EQ(event->timestamp, 1'000'000 * n + 5'000'000);
    EXPECT_STREQ(event->channel, "C");
    EXPECT_EQ(event->datalen, n);
    lcm_eventlog_free_event(event);
  }
  EXPECT_EQ(lcm_eventlog_read_next_event(log), nullptr);
  lcm_eventlog_destroy(log);
}

TEST_F(LogFile, IsReadFromAnyTime) {
  write_ten();
  for (const auto& [from, first] : {std::pair{0, 0}, {5'000'000, 0}, {5'000'001, 1}, {9'000'000, 4}, {14'000'000, 9}}) {
    LogReader log = LogReader::open(file_).value();
    EXPECT_EQ(log.first_utime(), 5'000'000);
    ASSERT_TRUE(log.skip_to(from));
    for (int n = first; n < 10; ++n) {
      const auto message = test::good(log.next().value());
      EXPECT_EQ(message->payload, std::vector<std::uint8_t>(static_cast<std::size_t>(n), static_cast<std::uint8_t>(n)));
      EXPECT_EQ(message->channel, "C");
    }
    EXPECT_FALSE(log.next().value());
    EXPECT_FALSE(log.is_cut());
    EXPECT_EQ(log.fraction(), 1);
  }
  LogReader log = LogReader::open(file_).value();
  ASSERT_TRUE(log.skip_to(99'000'000));
  EXPECT_FALSE(log.next().value());
}

TEST_F(LogFile, ACutEndIsLeftOut) {
  write_ten();
  const std::string whole = content();
  const std::size_t last = 28 + 1 + 9;
  for (std::size_t cut = 1; cut < last; ++cut) {
    put(whole.substr(0, whole.size() - cut));
    LogReader log = LogReader::open(file_).value();
    for (int n = 0; n < 9; ++n) ASSERT_TRUE(log.next().value()) << cut;
    EXPECT_FALSE(log.next().value()) << cut;
    EXPECT_TRUE(log.is_cut());
  }
}

TEST_F(LogFile, DamageIsSaidWithItsPlace) {
  write_ten();
  const std::string whole = content();
  const std::size_t second = 28 + 1;
  for (const auto& [at, byte] : {std::pair{0, 'x'}, {12, '\xff'}, {20, '\x7f'}, {23, '\0'}, {24, '\x7f'}}) {
    std::string bytes = whole;
    bytes[second + static_cast<std::size_t>(at)] = byte;
    put(bytes);
    LogReader log = LogReader::open(file_).value();
    (void)log.next();  // liblcm looks at the beginning of the next one, too
    EXPECT_THAT(test::refusal(log.next()), testing::HasSubstr("at byte ")) << at;
  }
  put("This is no log, but it is long enough to hold the beginning of one.");
  const auto log = LogReader::open(file_);
  ASSERT_FALSE(log);
  EXPECT_NE(log.error().message.find("is no LCM log"), std::string::npos) << log.error().message;
  EXPECT_FALSE(LogReader::open("/nonexistent/log"));
  put("");
  EXPECT_FALSE(LogReader::open(file_).value().first_utime());
}

TEST_F(LogFile, TheLongestMessageIsRead) {
  const std::string channel(999, 'c');
  LogWriter log = LogWriter::create(file_).value();
  ASSERT_TRUE(log.write(1, channel, std::vector<std::uint8_t>(LogReader::kLongest)) && log.finish());
  EXPECT_EQ(LogReader::open(file_).value().next().value()->channel, channel);
}

TEST(FullDisk, IsSaid) {
  LogWriter log = LogWriter::create("/dev/full").value();
  EXPECT_THAT(test::refusal(log.write(1, "C", std::vector<std::uint8_t>(10))),
              testing::HasSubstr("No space left on device"));
  EXPECT_FALSE(LogWriter::create("/nonexistent/log"));
}

TEST(MessageJob, IsKnownOfEveryType) {
  EXPECT_EQ(job_of(kStatusChannel, encode(samples::make<status_t>())), "");
  EXPECT_EQ(job_of(kJobChannel, encode(samples::make<job_t>())), samples::make<job_t>().job_id);
  EXPECT_EQ(job_of(kObservablesChannel, encode(samples::make<observables_t>())), samples::make<observables_t>().job_id);
  EXPECT_EQ(job_of(kFrameStaticChannel, encode(samples::make<frame_static_t>())),
            samples::make<frame_static_t>().job_id);
  EXPECT_EQ(job_of(kFrameChannel, encode(samples::make<frame_t>())), samples::make<frame_t>().job_id);
  EXPECT_EQ(job_of(kDefectsChannel, encode(samples::make<defects_t>())), samples::make<defects_t>().job_id);
  EXPECT_EQ(job_of(kPostsChannel, encode(samples::make<posts_t>())), samples::make<posts_t>().job_id);
  EXPECT_EQ(job_of(kSizesChannel, encode(samples::make<sizes_t>())), samples::make<sizes_t>().job_id);
  EXPECT_FALSE(job_of(kJobChannel, encode(samples::make<frame_t>())));
  EXPECT_FALSE(job_of("OTHER", encode(samples::make<job_t>())));
}

}  // namespace
}  // namespace shaken::proto
