#include "client/watch/keys.h"

#include <optional>
#include <utility>

namespace shaken::client {
namespace {

constexpr char kEscapeByte = '\x1b';
constexpr std::size_t kLongestSequence = 32;

/// The length of the escape sequence (ECMA-48, 5.4 and 5.6) that `bytes` begins with; nothing if its end has not come.
std::optional<std::size_t> sequence_size(std::string_view bytes) {
  if (bytes.size() < 2) return std::nullopt;
  if (bytes[1] == 'O') return bytes.size() < 3 ? std::nullopt : std::optional<std::size_t>(3);
  if (bytes[1] != '[') return 1;  // Esc, and a key of its own
  for (std::size_t i = 2; i < bytes.size(); ++i) {
    if (bytes[i] >= 0x40 && bytes[i] <= 0x7E) return i + 1;
    if (i >= kLongestSequence) return i + 1;
  }
  return std::nullopt;
}

std::optional<Key::Kind> kind_of(std::string_view sequence) {
  if (sequence.size() == 1) return Key::Kind::kEscape;
  static constexpr std::pair<char, Key::Kind> kKinds[]{{'A', Key::Kind::kUp},
                                                       {'B', Key::Kind::kDown},
                                                       {'C', Key::Kind::kRight},
                                                       {'D', Key::Kind::kLeft},
                                                       {'Z', Key::Kind::kBackTab}};
  for (const auto& [last, kind] : kKinds) {
    if (sequence.back() == last) return kind;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Key> KeyReader::add(std::string_view bytes) {
  rest_ += bytes;
  std::vector<Key> keys;
  while (!rest_.empty()) {
    std::size_t size = 1;
    if (rest_.front() == kEscapeByte) {
      const std::optional<std::size_t> whole = sequence_size(rest_);
      if (!whole) break;
      size = *whole;
      if (const auto kind = kind_of(std::string_view(rest_).substr(0, size))) keys.push_back({*kind});
    } else if (static_cast<unsigned char>(rest_.front()) < 0x7F) {
      keys.push_back({Key::Kind::kCharacter, rest_.front()});
    }
    rest_.erase(0, size);
  }
  return keys;
}

std::vector<Key> KeyReader::flush() {
  std::vector<Key> keys;
  if (rest_.size() == 1) keys.push_back({Key::Kind::kEscape});
  rest_.clear();
  return keys;
}

}  // namespace shaken::client
