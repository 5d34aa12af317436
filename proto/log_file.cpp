#include "proto/log_file.h"

#include <lcm/eventlog.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace shaken::proto {
namespace {

constexpr std::uint64_t kMagic = 0xeda1da01;
constexpr std::int64_t kHeaderBytes = 28;                // magic, number of the message, time, two lengths
constexpr std::int64_t kLatest = std::int64_t{1} << 62;  // so that sums of times fit
constexpr std::int64_t kLongestChannel = 999;            // liblcm's own limit

Error log_error(const std::string& what, const std::filesystem::path& file) {
  return {what + " " + file.string() + ": " + std::strerror(errno)};
}

std::uint64_t number_at(const std::array<std::uint8_t, kHeaderBytes>& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = at; i < at + size; ++i) value = value << 8 | bytes[i];
  return value;
}

}  // namespace

void LogCloser::operator()(_lcm_eventlog_t* log) const { lcm_eventlog_destroy(log); }

Result<LogWriter> LogWriter::create(const std::filesystem::path& file) {
  LogHandle log(lcm_eventlog_create(file.c_str(), "w"));
  if (!log) return log_error("cannot write", file);
  return LogWriter(file, std::move(log));
}

std::int64_t LogWriter::size_of(std::string_view channel, std::span<const std::uint8_t> payload) {
  return kHeaderBytes + static_cast<std::int64_t>(channel.size() + payload.size());
}

Result<void> LogWriter::write(std::int64_t utime, std::string_view channel, std::span<const std::uint8_t> payload) {
  lcm_eventlog_event_t event{};
  event.timestamp = utime;
  event.channellen = static_cast<std::int32_t>(channel.size());
  event.datalen = static_cast<std::int32_t>(payload.size());
  event.channel = const_cast<char*>(channel.data());  // it is only read
  event.data = const_cast<std::uint8_t*>(payload.data());
  if (lcm_eventlog_write_event(log_.get(), &event) != 0 || fflush(log_->f) != 0) {
    const Error error = log_error("cannot write", file_);
    log_.reset();  // which tries once more to write what is left
    std::error_code ignored;
    std::filesystem::resize_file(file_, static_cast<std::uintmax_t>(bytes_), ignored);
    return error;
  }
  bytes_ += size_of(channel, payload);
  ++messages_;
  return {};
}

Result<void> LogWriter::finish() {
  if (fsync(fileno(log_->f)) != 0 && errno != EINVAL) return log_error("cannot write", file_);  // EINVAL: no disk
  log_.reset();
  return {};
}

Result<LogReader> LogReader::open(const std::filesystem::path& file) {
  std::error_code problem;
  const auto size = std::filesystem::file_size(file, problem);
  if (problem) return Error{"cannot read " + file.string() + ": " + problem.message()};
  LogHandle log(lcm_eventlog_create(file.c_str(), "r"));
  if (!log) return log_error("cannot read", file);
  LogReader reader(std::move(log), static_cast<std::int64_t>(size));
  const auto first = reader.peek();
  if (!first) return Error{file.string() + " is no LCM log: " + first.error().message};
  if (first->has_value()) reader.first_ = first->value().utime;
  return reader;
}

Result<std::optional<LogReader::Header>> LogReader::peek() {
  const std::int64_t left = size_ - at_;
  std::array<std::uint8_t, kHeaderBytes> bytes{};
  if (left < kHeaderBytes) {
    is_cut_ = left > 0;
    return std::optional<Header>();
  }
  if (fread(bytes.data(), 1, bytes.size(), log_->f) != bytes.size() || fseeko(log_->f, at_, SEEK_SET) != 0) {
    return Error{"it cannot be read at byte " + std::to_string(at_)};
  }
  const auto channel_size = static_cast<std::int64_t>(number_at(bytes, 20, 4));
  const auto payload_size = static_cast<std::int64_t>(number_at(bytes, 24, 4));
  const auto utime = static_cast<std::int64_t>(number_at(bytes, 12, 8));
  if (number_at(bytes, 0, 4) != kMagic || utime < 0 || utime > kLatest || channel_size < 1 ||
      channel_size > kLongestChannel || payload_size > kLongest) {
    return Error{"no message begins at byte " + std::to_string(at_)};
  }
  const Header header{utime, kHeaderBytes + channel_size + payload_size};
  if (header.size > left) {
    is_cut_ = true;
    return std::optional<Header>();
  }
  return std::optional<Header>(header);
}

Result<std::optional<LoggedMessage>> LogReader::next() {
  const auto header = SHAKEN_TRY(peek());
  if (!header) return std::optional<LoggedMessage>();
  lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log_.get());
  if (event == nullptr) return Error{"the message at byte " + std::to_string(at_) + " is damaged, or what follows it"};
  const auto* data = static_cast<const std::uint8_t*>(event->data);
  LoggedMessage message{
      event->timestamp, {event->channel, static_cast<std::size_t>(event->channellen)}, {data, data + event->datalen}};
  lcm_eventlog_free_event(event);
  at_ += header->size;
  return std::optional<LoggedMessage>(std::move(message));
}

Result<void> LogReader::skip_to(std::int64_t utime) {
  for (;;) {
    const auto header = SHAKEN_TRY(peek());
    if (!header || header->utime >= utime) return {};
    at_ += header->size;
    if (fseeko(log_->f, at_, SEEK_SET) != 0) return Error{"it cannot be read at byte " + std::to_string(at_)};
  }
}

double LogReader::fraction() const { return size_ > 0 ? static_cast<double>(at_) / static_cast<double>(size_) : 1; }

}  // namespace shaken::proto
