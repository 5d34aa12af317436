// SPDX-License-Identifier: MIT
#include "server/queue_rows.h"

#include "server/queue_words.h"

namespace shaken::server {
namespace {

using std::chrono::milliseconds;

Hold stored_hold(const std::string& word) {
  if (word == kForRoom) return Hold::kRoom;
  if (word == kForOthers) return Hold::kOthers;
  if (word == kByRule) return Hold::kRule;
  return word == kOnRequest ? Hold::kRequest : Hold::kNone;
}

Job read_job(const Query& query) {
  Job job;
  job.sweep = query.integer(0);
  job.label = query.text(1);
  job.parameters = query.text(2);
  job.replica = static_cast<int>(query.integer(3));
  job.id = query.text(4);
  job.state = stored_state(query.text(5));
  job.reason = query.text(6);
  job.attempt = static_cast<int>(query.integer(7));
  job.pid = static_cast<int>(query.integer(8));
  job.created = query.integer(9);
  job.started = query.integer(10);
  job.finished = query.integer(11);
  job.priority = static_cast<int>(query.integer(12));
  job.hold = stored_hold(query.text(13));
  job.needed_bytes = query.integer(14);
  job.not_before = query.integer(15);
  job.soft_limit = milliseconds(query.integer(16));
  job.time_limit = milliseconds(query.integer(17));
  job.wall = milliseconds(query.integer(18));
  job.asked_by = query.integer(19);
  job.waits = query.integer(20) != 0;
  return job;
}

}  // namespace

std::vector<Job> read_jobs(Query query) {
  std::vector<Job> jobs;
  while (query.next()) jobs.push_back(read_job(query));
  return jobs;
}

JobState stored_state(const std::string& word) {
  const auto state = job_state(word);
  if (!state) throw StorageError("queue.db is damaged: '" + word + "' is no state of a job");
  return *state;
}

}  // namespace shaken::server
