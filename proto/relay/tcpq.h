#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "proto/relay/limits.h"

namespace shaken::relay {

/// The protocol of LCM's tcpq:// addresses, as pure functions. All numbers are big-endian and have 32 bits.
///
/// Each side begins with a word of its own and the version 0x0100. Then a client sends instructions: a kind, the length
/// of a text and the text; for kPublish the text is a channel, and the length of the payload and the payload follow;
/// for the others it is a regular expression. The server sends nothing but messages, in the form of kPublish.
/// Source: lcm/lcm_tcpq.c and TCPService.java of LCM 1.3.1, which differ in nothing of this.
enum class Kind : std::uint32_t { kPublish = 1, kSubscribe = 2, kUnsubscribe = 3 };

inline constexpr std::size_t kGreetingBytes = 8;

/// What a server says first.
std::string server_greeting();
/// What a client says first.
std::string client_greeting();

enum class Greeting { kIncomplete, kRight, kWrong };
/// Whether `bytes` begin as a client does; wrong as soon as one byte is.
Greeting greeting_of(std::string_view bytes);

/// One instruction; the texts are parts of what was parsed.
struct Instruction {
  Kind kind = Kind::kPublish;
  std::string_view text;     ///< channel, or regular expression
  std::string_view payload;  ///< kPublish only
  std::size_t size = 0;      ///< bytes that it takes
};
/// More bytes are needed.
struct Incomplete {};
/// No instruction begins like this; the reason, without what was sent.
struct Unreadable {
  std::string reason;
};
using Parsed = std::variant<Incomplete, Instruction, Unreadable>;

/// The instruction with which `bytes` begin. Lengths beyond the limits are refused as soon as they have been read.
Parsed parse_instruction(std::string_view bytes, const Limits& limits);

/// A message as a server, or a client that publishes, sends it.
std::string publication(std::string_view channel, std::string_view payload);
/// A client's instruction of one of the other two kinds.
std::string subscription(Kind kind, std::string_view pattern);

}  // namespace shaken::relay
