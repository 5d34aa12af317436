#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shaken::keys {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (optimal string
/// alignment distance), upper and lower case counted as equal.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate closest to `word`, if it is close enough to be a slip of the pen; otherwise empty.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

/// "; did you mean X?", or nothing if `name` is empty.
std::string did_you_mean(std::string_view name);

}  // namespace shaken::keys
