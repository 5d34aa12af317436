#pragma once

#include <cstdint>
#include <string>

namespace shaken::client {

/// Bytes from "500MB", "2 GB" or "64000"; a kB has 1000. `option` is named in the message. Throws Failure (kBadInput)
/// for anything else, and unless it is at least one byte.
std::int64_t size_option(const std::string& option, const std::string& text);

}  // namespace shaken::client
