// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "server/job.h"
#include "server/queue.h"

namespace shaken::server {

using Json = nlohmann::ordered_json;

/// JOB of docs/protocol.md, with the progress that its worker has written. `runs`: folder of the run directories.
Json job_report(const Job& job, const std::filesystem::path& runs);

/// SWEEP of docs/protocol.md. `active`: its running and stopping jobs.
Json sweep_report(const Sweep& sweep, std::span<const Job> active, std::optional<double> mean_duration, int slots,
                  const std::filesystem::path& runs);

/// A row of the results table of docs/protocol.md.
Json result_row(const Job& job, const std::filesystem::path& runs);

/// {"queued": n, ...}, every state.
Json counts_report(const JobCounts& counts);

/// Text for an answer: what is not UTF-8 in it (the end of a log, say) is replaced.
std::string to_text(const Json& json);

}  // namespace shaken::server
