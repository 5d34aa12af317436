// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace shaken::server {

/// The scene `present` (canonical text), made as long as `wanted`, another text of the same run, also asks for;
/// `present` itself if it is that long already, `wanted` if the two are not of one run or `present` cannot be read.
std::string as_long_as_both(const std::string& present, const std::string& wanted);

}  // namespace shaken::server
