#pragma once

#include <optional>

#include "base/steadiness.h"
#include "client/live/json.h"

namespace shaken::client {

/// Mean S of a run that is done, and of what kind of time it is.
struct MeanOrder {
  double value = 0;
  Steadiness steadiness = Steadiness::kSteady;
};

/// That of a JOB object of the API, from the summary in its directory; none if the job is not done or its summary has
/// no mean S.
std::optional<MeanOrder> mean_order(const Json& job);

}  // namespace shaken::client
