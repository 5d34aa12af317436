#pragma once

/// The LCM channels of Shaken: one type per channel, named beside it.
namespace shaken::proto {

inline constexpr const char* kStatusChannel = "SHAKEN_STATUS";             ///< status_t
inline constexpr const char* kJobChannel = "SHAKEN_JOB";                   ///< job_t
inline constexpr const char* kObservablesChannel = "SHAKEN_OBSERVABLES";   ///< observables_t
inline constexpr const char* kFrameStaticChannel = "SHAKEN_FRAME_STATIC";  ///< frame_static_t
inline constexpr const char* kFrameChannel = "SHAKEN_FRAME";               ///< frame_t
inline constexpr const char* kDefectsChannel = "SHAKEN_DEFECTS";           ///< defects_t
inline constexpr const char* kPostsChannel = "SHAKEN_POSTS";               ///< posts_t
inline constexpr const char* kSizesChannel = "SHAKEN_SIZES";               ///< sizes_t

}  // namespace shaken::proto
