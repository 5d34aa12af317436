// How often a property is tried.
#pragma once

#include <cstdlib>

namespace shaken::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

/// Whether all that takes long is tried as well: `./dev test all`.
inline bool at_night() { return std::getenv("SHAKEN_NIGHT") != nullptr; }

/// As many of `n` draws as are made now. A tenth of them touches all the code; that a law holds in every one of them
/// is for the night to show.
inline int draws(int n) { return at_night() ? n : n / 10; }

}  // namespace shaken::test
