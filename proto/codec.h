#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <shaken/defects_t.hpp>
#include <shaken/frame_static_t.hpp>
#include <shaken/frame_t.hpp>
#include <shaken/job_t.hpp>
#include <shaken/observables_t.hpp>
#include <shaken/posts_t.hpp>
#include <shaken/sizes_t.hpp>
#include <shaken/status_t.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shaken::proto {

/// The fields of a message in order, one letter each: `8` and `4` are numbers of that many bytes, `s` a string, `n` the
/// length of the arrays that follow, `D`, `W`, `H` and `B` arrays of n numbers of 8, 4, 2 bytes and 1 byte.
/// lcm-gen's decoders trust lengths inside a payload (a large one makes them read past its end), so every payload is
/// held against this first. Spaces are for the reader: common head, then the rest.
template <class T>
inline constexpr std::string_view kLayout = "";
template <>
inline constexpr std::string_view kLayout<status_t> = "88 s4ss8 444444";
template <>
inline constexpr std::string_view kLayout<job_t> = "88s sss s4 88888";
template <>
inline constexpr std::string_view kLayout<observables_t> = "88s8 84 88888888 888 88";
template <>
inline constexpr std::string_view kLayout<frame_static_t> = "88s8 4888 nW nDD nB s88 s";
template <>
inline constexpr std::string_view kLayout<frame_t> = "88s8 88888 4444 nHHHH";
template <>
inline constexpr std::string_view kLayout<defects_t> = "88s8 8 nDDDD";
template <>
inline constexpr std::string_view kLayout<posts_t> = "88s8 8 nDD";
template <>
inline constexpr std::string_view kLayout<sizes_t> = "88s8 nB";

/// The length that a payload beginning like this one must have [bytes], fingerprint included; none if a length inside
/// it is negative, a string does not end in its first NUL, or the payload ends before its arrays do.
std::optional<std::size_t> message_size(std::string_view layout, std::span<const std::uint8_t> payload);

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
  static_assert(!kLayout<T>.empty(), "kLayout must describe every type");
  if (message_size(kLayout<T>, payload) != payload.size()) return std::nullopt;
  T message;
  const int size = static_cast<int>(payload.size());
  if (message.decode(payload.data(), 0, size) != size) return std::nullopt;
  return message;
}

/// The id of the job that a message tells of; empty for one of the daemon itself. None if the channel is not one of
/// Shaken's, or the payload is not of its type.
std::optional<std::string> job_of(std::string_view channel, std::span<const std::uint8_t> payload);

}  // namespace shaken::proto
