// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "server/queue.h"

namespace shaken::server {

/// Before runs could be extended, the id of a run depended on its length too. Gives the jobs of a queue from that time,
/// and the folders of their runs, the ids of today; once, and again from where a crash has ended it. Runs that differed
/// in their length only become one: the longest of those that are done, else of those that are to run, else of the
/// rest; the folders of the others stay as they are.
void renew_ids(Queue& queue, const std::filesystem::path& runs);

}  // namespace shaken::server
