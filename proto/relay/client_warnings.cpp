#include "proto/relay/client_warnings.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace shaken::relay {

void ClientWarnings::note(const std::string& what, std::chrono::steady_clock::time_point now) {
  constexpr std::chrono::seconds kPause{10};
  if (now < next_) {
    ++kept_back_;
    return;
  }
  next_ = now + kPause;
  const std::int64_t others = std::exchange(kept_back_, 0);
  if (others > 0) {
    spdlog::warn("relay: {}; {} such warnings were left out before", what, others);
  } else {
    spdlog::warn("relay: {}", what);
  }
}

}  // namespace shaken::relay
