// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "client/results.h"
#include "client/session.h"
#include "client/target.h"

namespace shaken::client {

/// The daemon's results of a sweep, or of one job.
std::vector<ResultRow> result_rows(Session& session, const Target& target);

}  // namespace shaken::client
