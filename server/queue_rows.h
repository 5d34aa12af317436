// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "server/job.h"
#include "server/sqlite.h"

namespace shaken::server {

/// What a job is by itself; read_jobs has it after its place in a sweep.
inline const std::string kColumns =
    ", j.id, j.state, j.reason, j.attempt, j.pid, j.created_utime, j.started_utime, j.finished_utime, j.priority, "
    "j.hold, j.needed_bytes, j.not_before_utime, j.soft_limit_ms, j.time_limit_ms, j.wall_ms, "
    "j.sweep, j.waits ";
inline const std::string kSelectJobs = "SELECT j.sweep, j.label, j.parameters, j.replica" + kColumns + "FROM jobs j ";
inline const std::string kSelectMembers = "SELECT m.sweep, m.label, m.parameters, m.replica" + kColumns +
                                          "FROM members m JOIN jobs j ON j.number = m.job WHERE m.sweep = ?1 ";

/// The jobs of a query that begins with one of these.
std::vector<Job> read_jobs(Query query);

/// Throws StorageError where it is the word for no state.
JobState stored_state(const std::string& word);

}  // namespace shaken::server
