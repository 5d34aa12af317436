// SPDX-License-Identifier: MIT
// What programs say, and whether it has arrived.
#pragma once

#include <string_view>

#include "sim/core/result.h"

namespace shaken {

/// `line` on stderr. That it cannot be written there changes nothing: there is nobody left to be told. (fmt::print
/// throws then, which ends a program by SIGABRT where it is told why it fails.)
void complain(std::string_view line);

/// Brings to its destination what has been printed on stdout by way of stdio or std::cout, or the reason why it cannot.
Result<void> flush_standard_output();

}  // namespace shaken
