// LCM's own log files, which lcm-logger writes and lcm-logplayer plays.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"

struct _lcm_eventlog_t;

namespace shaken::proto {

/// A message as a log has it.
struct LoggedMessage {
  std::int64_t utime = 0;  ///< when it was received [microseconds since 1970-01-01 UTC]
  std::string channel;
  std::vector<std::uint8_t> payload;
};

/// Closes what lcm_eventlog_create has opened.
struct LogCloser {
  void operator()(_lcm_eventlog_t* log) const;
};
using LogHandle = std::unique_ptr<_lcm_eventlog_t, LogCloser>;

/// Writes a log. After each message the file is whole.
class LogWriter {
 public:
  /// Replaces a file that is there.
  static Result<LogWriter> create(const std::filesystem::path& file);

  /// If the disk takes no more, the error says why, the file ends with the last message before, and nothing may be
  /// written any more.
  Result<void> write(std::int64_t utime, std::string_view channel, std::span<const std::uint8_t> payload);
  /// Makes sure that everything is on the disk.
  Result<void> finish();
  std::int64_t bytes() const { return bytes_; }
  std::int64_t messages() const { return messages_; }

  /// What a message takes in the file.
  static std::int64_t size_of(std::string_view channel, std::span<const std::uint8_t> payload);

 private:
  LogWriter(std::filesystem::path file, LogHandle log) : file_(std::move(file)), log_(std::move(log)) {}

  std::filesystem::path file_;
  LogHandle log_;
  std::int64_t bytes_ = 0;
  std::int64_t messages_ = 0;
};

/// Reads a log from front to back. Lengths in the file are held against what is there before liblcm believes them.
class LogReader {
 public:
  /// Messages longer than this are taken for damage; LCM's multicast carries 16 MiB at most.
  static constexpr std::int64_t kLongest = 64 << 20;

  static Result<LogReader> open(const std::filesystem::path& file);

  /// The next message; none at the end. The error names the place of what is damaged.
  Result<std::optional<LoggedMessage>> next();
  /// Goes on to the first message that is not earlier than `utime`, without reading what lies between.
  Result<void> skip_to(std::int64_t utime);
  /// The time of the first message; none in an empty log.
  std::optional<std::int64_t> first_utime() const { return first_; }
  /// Whether the file ends within a message: whoever wrote it was killed, or had no more room. That message is left
  /// out.
  bool is_cut() const { return is_cut_; }
  /// How much of the file has been read, 0 to 1.
  double fraction() const;

 private:
  struct Header {
    std::int64_t utime = 0;
    std::int64_t size = 0;  ///< of the whole message, header included
  };
  LogReader(LogHandle log, std::int64_t size) : log_(std::move(log)), size_(size) {}
  /// The header at the present place, which stays; none at the end.
  Result<std::optional<Header>> peek();

  LogHandle log_;
  std::int64_t size_ = 0;  ///< of the file [bytes]
  std::int64_t at_ = 0;    ///< [bytes]
  std::optional<std::int64_t> first_;
  bool is_cut_ = false;
};

}  // namespace shaken::proto
