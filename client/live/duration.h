#pragma once

#include <string>

namespace shaken::client {

/// Seconds of wall time from "10min", "2h", "30d" or "90 s"; a number alone is in seconds. `option` is named in the
/// message. Throws Failure (kBadInput) for anything else, and unless it is more than nothing.
double duration_option(const std::string& option, const std::string& text);

}  // namespace shaken::client
