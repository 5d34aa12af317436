// SPDX-License-Identifier: MIT
// How often a property is tried.
#pragma once

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

/// Of `n` draws, as many as this build makes. Sanitizers look at what the code touches, and a tenth of the draws
/// touches it all; that a law holds in every one of them is for the build without to show.
constexpr int draws(int n) { return kSanitized ? n / 10 : n; }

}  // namespace shaken::test
