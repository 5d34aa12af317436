#pragma once

namespace shaken::run {

/// "0.1.0"
const char* version();
/// "g++ 12.2.0, Release"
const char* compiler();

}  // namespace shaken::run
