// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace shaken::server {

/// What a held job waits for, as the queue's tables have it.
inline constexpr std::string_view kOnRequest = "request";
inline constexpr std::string_view kForRoom = "room";
inline constexpr std::string_view kForOthers = "others";
inline constexpr std::string_view kByRule = "rule";

/// What becomes of a stopping job that is queued behind all of its priority; the others become a state.
inline constexpr std::string_view kLast = "last";

/// Why a job whose results were removed is cancelled.
inline constexpr std::string_view kCleaned = "cleaned on request";

}  // namespace shaken::server
