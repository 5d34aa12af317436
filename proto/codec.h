#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "proto/message_layout.h"

namespace shaken::proto {

/// The payload of a message. Arrays must be as long as their count fields say; strings must hold no NUL.
template <class T>
std::vector<std::uint8_t> encode(const T& message) {
  std::vector<std::uint8_t> payload(static_cast<std::size_t>(message.getEncodedSize()));
  const int written = message.encode(payload.data(), 0, static_cast<int>(payload.size()));
  payload.resize(written > 0 ? static_cast<std::size_t>(written) : 0);
  return payload;
}

/// The message, or none if the payload is of another type, cut short, or has as much as one byte too many.
template <class T>
std::optional<T> decode(std::span<const std::uint8_t> payload) {
  static_assert(!kLayout<T>.empty(), "proto/message_layout.h must describe every type");
  if (message_size(kLayout<T>, payload) != payload.size()) return std::nullopt;
  T message;
  const int size = static_cast<int>(payload.size());
  if (message.decode(payload.data(), 0, size) != size) return std::nullopt;
  return message;
}

}  // namespace shaken::proto
