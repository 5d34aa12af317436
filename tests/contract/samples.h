#pragma once

#include <bit>
#include <stdexcept>
#include <string>
#include <vector>

#include "proto/codec.h"

namespace shaken::proto::samples {

inline constexpr std::int64_t kTime = 1'700'000'000'123'456;  ///< of every message [us]

/// A message with every field set to something that can be told from the others, arrays of three numbers each. The
/// fields are those of kLayout, so that lcm-gen's own decoder says whether that is right.
template <class T>
T make() {
  std::vector<std::uint8_t> payload;
  const auto put = [&](std::uint64_t value, int n_bytes) {
    for (int k = n_bytes; k-- > 0;) payload.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  };
  const auto fingerprint = static_cast<std::uint64_t>(T::getHash());
  put(fingerprint, 8);
  std::uint64_t field = 0;
  for (const char letter : kLayout<T>) {
    if (letter == ' ') continue;
    const std::uint64_t eight = field == 0   ? kTime
                                : field == 1 ? fingerprint >> 48
                                             : std::bit_cast<std::uint64_t>(1.5 + field);
    const std::string text = "text " + std::to_string(field);
    const int width = letter == 'D' ? 8 : letter == 'W' ? 4 : letter == 'H' ? 2 : 1;  // of an array
    switch (letter) {
      case '8':
        put(eight, 8);
        break;
      case '4':
        put(100 + field, 4);
        break;
      case 'n':
        put(3, 4);
        break;
      case 's':
        put(text.size() + 1, 4);
        payload.insert(payload.end(), text.c_str(), text.c_str() + text.size() + 1);
        break;
      default:
        for (std::uint64_t k = 1; k <= 3; ++k) put(width == 8 ? eight + k : 10 * field + k, width);
    }
    ++field;
  }
  T message;
  if (message.decode(payload.data(), 0, static_cast<int>(payload.size())) != static_cast<int>(payload.size()))
    throw std::logic_error("kLayout is not that of the type");
  return message;
}

}  // namespace shaken::proto::samples
