// SPDX-License-Identifier: MIT
#include "server/terms.h"

#include <fmt/format.h>

#include "base/text.h"

namespace shaken::server {

std::string time_limit_over(std::chrono::milliseconds limit) {
  return fmt::format("it ran for {}, its time limit; `shaken retry` gives it as much again",
                     duration_text(std::chrono::duration<double>(limit).count()));
}

}  // namespace shaken::server
