#include "proto/relay/tcpq.h"

#include <algorithm>

namespace shaken::relay {
namespace {

constexpr std::uint32_t kServerWord = 0x287617fa;
constexpr std::uint32_t kClientWord = 0x287617fb;
constexpr std::uint32_t kVersion = 0x0100;
constexpr std::size_t kWordBytes = 4;

void append_word(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift & 0xff));
}

/// The number at `at`, of which there must be four bytes.
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + kWordBytes; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

std::string greeting(std::uint32_t word) {
  std::string bytes;
  append_word(bytes, word);
  append_word(bytes, kVersion);
  return bytes;
}

void append_text(std::string& bytes, std::string_view text) {
  append_word(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

}  // namespace

std::string server_greeting() { return greeting(kServerWord); }

std::string client_greeting() { return greeting(kClientWord); }

Greeting greeting_of(std::string_view bytes) {
  const std::string right = client_greeting();
  const std::size_t n = std::min(bytes.size(), right.size());
  if (bytes.substr(0, n) != std::string_view(right).substr(0, n)) return Greeting::kWrong;
  return n < right.size() ? Greeting::kIncomplete : Greeting::kRight;
}

Parsed parse_instruction(std::string_view bytes, const Limits& limits) {
  if (bytes.size() < kWordBytes) return Incomplete{};
  const std::uint32_t kind = word_at(bytes, 0);
  if (kind < 1 || kind > 3) return Unreadable{"an instruction of no known kind"};
  Instruction instruction;
  instruction.kind = static_cast<Kind>(kind);
  const bool publishes = instruction.kind == Kind::kPublish;

  if (bytes.size() < 2 * kWordBytes) return Incomplete{};
  const std::size_t text_size = word_at(bytes, kWordBytes);
  const std::size_t most = publishes ? limits.channel : limits.pattern;
  if (text_size == 0 || text_size > most) {
    return Unreadable{std::string(publishes ? "a channel" : "a subscription") + " of " + std::to_string(text_size) +
                      " bytes: 1 to " + std::to_string(most) + " are taken"};
  }
  const std::size_t text_end = 2 * kWordBytes + text_size;
  instruction.size = text_end;
  if (publishes) {
    if (bytes.size() < text_end + kWordBytes) return Incomplete{};
    const std::size_t payload_size = word_at(bytes, text_end);
    if (payload_size > limits.payload) {
      return Unreadable{"a message of " + std::to_string(payload_size) + " bytes: up to " +
                        std::to_string(limits.payload) + " are taken"};
    }
    instruction.size = text_end + kWordBytes + payload_size;
    if (bytes.size() < instruction.size) return Incomplete{};
    instruction.payload = bytes.substr(text_end + kWordBytes, payload_size);
  }
  if (bytes.size() < instruction.size) return Incomplete{};
  instruction.text = bytes.substr(2 * kWordBytes, text_size);
  if (instruction.text.find('\0') != std::string_view::npos) return Unreadable{"a name with a NUL in it"};
  return instruction;
}

std::string publication(std::string_view channel, std::string_view payload) {
  std::string bytes;
  bytes.reserve(3 * kWordBytes + channel.size() + payload.size());
  append_word(bytes, static_cast<std::uint32_t>(Kind::kPublish));
  append_text(bytes, channel);
  append_text(bytes, payload);
  return bytes;
}

std::string subscription(Kind kind, std::string_view pattern) {
  std::string bytes;
  append_word(bytes, static_cast<std::uint32_t>(kind));
  append_text(bytes, pattern);
  return bytes;
}

}  // namespace shaken::relay
