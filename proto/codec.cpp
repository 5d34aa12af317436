#include "proto/codec.h"

#include <algorithm>

#include "proto/channels.h"

namespace shaken::proto {
namespace {

constexpr std::size_t kFingerprintBytes = 8;

/// Bytes of a number, be it by itself or in an array; a space has none.
constexpr std::size_t bytes_of(char field) {
  if (field == '8' || field == 'D') return 8;
  if (field == '4' || field == 'W') return 4;
  return field == 'H' ? 2 : field == 'B' ? 1 : 0;
}

/// Walks over a payload without ever leaving it.
class Walker {
 public:
  explicit Walker(std::span<const std::uint8_t> payload) : payload_(payload) {}

  bool skip(std::size_t bytes) {
    if (bytes > payload_.size() - at_) return false;
    at_ += bytes;
    return true;
  }
  /// A big-endian length, which must not be negative.
  std::optional<std::size_t> length() {
    const std::size_t begin = at_;
    if (!skip(4)) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = begin; i < at_; ++i) value = value << 8 | payload_[i];
    if (value > static_cast<std::uint32_t>(INT32_MAX)) return std::nullopt;
    return value;
  }
  /// A length that counts the closing NUL, and as many bytes, of which only the last is NUL.
  bool skip_string() {
    const auto bytes = length();
    if (!bytes || *bytes == 0 || !skip(*bytes)) return false;
    const auto string = payload_.subspan(at_ - *bytes, *bytes);
    return std::find(string.begin(), string.end(), 0) == string.end() - 1;
  }
  std::size_t position() const { return at_; }

 private:
  std::span<const std::uint8_t> payload_;
  std::size_t at_ = 0;
};

template <class T>
std::optional<std::string> job_in(std::span<const std::uint8_t> payload) {
  const std::optional<T> message = decode<T>(payload);
  if (!message) return std::nullopt;
  if constexpr (requires { message->job_id; }) {
    return message->job_id;
  } else {
    return std::string();
  }
}

}  // namespace

std::optional<std::size_t> message_size(std::string_view layout, std::span<const std::uint8_t> payload) {
  Walker walker(payload);
  bool fits = walker.skip(kFingerprintBytes);
  std::size_t n = 0;
  for (const char field : layout) {
    if (field == 'n') {
      const auto length = walker.length();
      fits = fits && length;
      n = length.value_or(0);
    } else if (field == 's') {
      fits = fits && walker.skip_string();
    } else {
      const bool is_array = field >= 'A' && field <= 'Z';
      fits = fits && walker.skip(bytes_of(field) * (is_array ? n : 1));
    }
  }
  if (!fits) return std::nullopt;
  return walker.position();
}

std::optional<std::string> job_of(std::string_view channel, std::span<const std::uint8_t> payload) {
  if (channel == kStatusChannel) return job_in<status_t>(payload);
  if (channel == kJobChannel) return job_in<job_t>(payload);
  if (channel == kObservablesChannel) return job_in<observables_t>(payload);
  if (channel == kFrameStaticChannel) return job_in<frame_static_t>(payload);
  if (channel == kFrameChannel) return job_in<frame_t>(payload);
  if (channel == kDefectsChannel) return job_in<defects_t>(payload);
  if (channel == kPostsChannel) return job_in<posts_t>(payload);
  if (channel == kSizesChannel) return job_in<sizes_t>(payload);
  return std::nullopt;
}

}  // namespace shaken::proto
