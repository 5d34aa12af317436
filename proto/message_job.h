#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace shaken::proto {

/// The id of the job that a message tells of; empty for one of the daemon itself. None if the channel is not one of
/// Shaken's, or the payload is not of its type.
std::optional<std::string> job_of(std::string_view channel, std::span<const std::uint8_t> payload);

}  // namespace shaken::proto
