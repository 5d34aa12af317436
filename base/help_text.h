#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace shaken {

/// A help text whose lines are no longer than `width` columns. What is described (an option, a verb, an example) keeps
/// its column, and its description goes on below itself; prose is broken between words. A command that is longer than
/// that stays whole, for it is there to be copied.
std::string wrapped_help(std::string_view text, std::size_t width = 80);

}  // namespace shaken
