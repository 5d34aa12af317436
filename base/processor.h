// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace shaken {

/// The processor of this machine as it calls itself, "Intel(R) Xeon(R) CPU @ 2.20GHz"; "unknown CPU" where it does not.
std::string cpu_name();

}  // namespace shaken
