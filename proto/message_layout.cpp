#include "proto/message_layout.h"

#include <algorithm>

namespace shaken::proto {
namespace {

constexpr std::size_t kFingerprintBytes = 8;

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

}  // namespace

std::optional<std::size_t> message_size(std::string_view layout, std::span<const std::uint8_t> payload) {
  Walker walker(payload);
  bool fits = walker.skip(kFingerprintBytes);
  std::size_t n = 0;
  for (const char field : layout) {
    switch (field) {
      case '8':
        fits = fits && walker.skip(8);
        break;
      case '4':
        fits = fits && walker.skip(4);
        break;
      case 's':
        fits = fits && walker.skip_string();
        break;
      case 'D':
        fits = fits && walker.skip(8 * n);
        break;
      case 'W':
        fits = fits && walker.skip(4 * n);
        break;
      case 'B':
        fits = fits && walker.skip(n);
        break;
      case 'H':
        fits = fits && walker.skip(2 * n);
        break;
      case 'n': {
        const auto length = walker.length();
        fits = fits && length;
        n = length.value_or(0);
        break;
      }
      default:
        break;  // a space
    }
  }
  if (!fits) return std::nullopt;
  return walker.position();
}

}  // namespace shaken::proto
