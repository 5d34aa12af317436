#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/core/result.h"

namespace shaken::relay {

/// Where a relay listens. LCM's tcpq knows IPv4 alone, and Debian's takes numbers only.
struct Address {
  std::uint32_t host = 0;  ///< in the order of this machine's bytes
  std::uint16_t port = 0;  ///< 0: any that is free

  /// Whether only programs of this machine reach it.
  bool is_loopback() const { return host >> 24 == 127; }
  /// "127.0.0.1:7700"
  std::string text() const;
  /// How a program of this machine reaches it: "tcpq://127.0.0.1:7700".
  std::string url() const;
};

/// From "127.0.0.1:7700". An error says what is expected.
Result<Address> parse_address(std::string_view text);

}  // namespace shaken::relay
