#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "server/queue/job.h"
#include "server/queue/queue.h"

namespace shaken::server {

using Json = nlohmann::ordered_json;

/// JOB of docs/protocol.md, with the progress that its worker has written. `runs`: folder of the run directories.
Json job_report(const Job& job, const std::filesystem::path& runs);

/// Why a job is in its state, or what it waits for; not for its turn once its worker tells that it is at work, which
/// the executor may hear of later.
std::string reason_of(const Job& job, const std::filesystem::path& runs);

/// What all sweeps wait for together.
struct Line {
  std::map<std::int64_t, double> ahead;  ///< see Queue::work_ahead
  double running_s = 0;                  ///< wall seconds that the running jobs have left, one after the other
  int n_running = 0;                     ///< jobs of which that is known
};

/// `active`: the running jobs of all sweeps.
Line line_of(std::map<std::int64_t, double> ahead, std::span<const Job> active, const std::filesystem::path& runs);

/// SWEEP of docs/protocol.md. `begun`: its jobs that have not ended, and were started.
Json sweep_report(const Sweep& sweep, std::span<const Job> begun, const SweepWork& work, const Line& line, int slots,
                  const std::filesystem::path& runs);

/// A row of the results table of docs/protocol.md.
Json result_row(const Job& job, const std::filesystem::path& runs);

/// {"queued": n, ...}, every state.
Json counts_report(const JobCounts& counts);

/// Text for an answer: what is not UTF-8 in it (the end of a log, say) is replaced.
std::string to_text(const Json& json);

/// A piece of a growing text file.
struct LogSlice {
  std::string text;
  std::int64_t next = 0;  ///< the offset to ask for next [bytes]
};

/// At most `limit` bytes from `offset` on, ending between two UTF-8 characters. Empty if the file cannot be read
/// or ends before `offset`.
LogSlice read_slice(const std::filesystem::path& file, std::int64_t offset, std::int64_t limit);

}  // namespace shaken::server
