#include "proto/message_job.h"

#include "proto/channels.h"
#include "proto/codec.h"

namespace shaken::proto {
namespace {

template <class T>
std::optional<std::string> job_in(std::span<const std::uint8_t> payload) {
  const std::optional<T> message = decode<T>(payload);
  if (!message) return std::nullopt;
  if constexpr (requires { message->job_id; }) {
    return message->job_id;
  } else {
    return std::string();
  }
}

}  // namespace

std::optional<std::string> job_of(std::string_view channel, std::span<const std::uint8_t> payload) {
  if (channel == kStatusChannel) return job_in<status_t>(payload);
  if (channel == kJobChannel) return job_in<job_t>(payload);
  if (channel == kObservablesChannel) return job_in<observables_t>(payload);
  if (channel == kFrameStaticChannel) return job_in<frame_static_t>(payload);
  if (channel == kFrameChannel) return job_in<frame_t>(payload);
  if (channel == kDefectsChannel) return job_in<defects_t>(payload);
  if (channel == kPostsChannel) return job_in<posts_t>(payload);
  if (channel == kSizesChannel) return job_in<sizes_t>(payload);
  return std::nullopt;
}

}  // namespace shaken::proto
