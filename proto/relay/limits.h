#pragma once

#include <chrono>
#include <cstddef>

namespace shaken::relay {

/// What a relay takes from its clients and keeps for them. Anybody who reaches it may be one, so everything has a
/// limit.
struct Limits {
  std::size_t clients = 64;                    ///< connected at once; those beyond are closed at once
  std::size_t subscriptions = 32;              ///< of one client
  std::size_t pattern = 256;                   ///< bytes of a subscription
  std::size_t program = 400;                   ///< instructions of RE2 in all patterns of one client; ".*" has ten
  std::size_t turn = 8;                        ///< instructions of one client before the others have their turn
  std::size_t channel = 63;                    ///< bytes of a channel's name, LCM's own limit
  std::size_t payload = std::size_t{1} << 20;  ///< bytes of a message
  std::size_t waiting_messages = 1000;         ///< for one client, beside the one that is on its way
  std::size_t waiting_bytes = std::size_t{4} << 20;
  std::chrono::seconds greeting{5};      ///< for a client to say that it speaks tcpq
  std::chrono::seconds message{30};      ///< from the first byte of a message to its last
  std::chrono::seconds standstill{120};  ///< for a client to take something of what waits for it
};

}  // namespace shaken::relay
