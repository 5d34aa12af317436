#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/job_state.h"
#include "base/steadiness.h"
#include "client/live/api_client.h"
#include "client/live/json.h"

namespace shaken::client {

/// What an ID of the command line stands for: all jobs of a sweep, or one job.
struct Target {
  std::string path;  ///< in the API, "/v1/sweeps/s1" or "/v1/jobs/1f0c..."
  Json answer;       ///< of GET path, when it was looked up
  bool is_sweep = false;

  std::string sweep_id() const;
  /// Its own id: "s1", or all 16 digits of a job's.
  std::string id() const;
  /// "sweep s1" or "job 1f0c...".
  std::string title() const;
};

/// Finds a sweep by id or name, or else a job by a prefix of its id. Throws Failure (kBadInput) if there is none.
Target find_target(ApiClient& session, const std::string& id);
/// All of these. They are found before the first job is changed: a slip in the last one must not cost the others.
std::vector<Target> find_targets(ApiClient& session, const std::vector<std::string>& ids);

/// Whether `id` is the path of a run directory rather than the ID of a job: `shaken run` makes such directories without
/// any daemon knowing of them.
bool is_run_directory(const std::string& id);

/// A job's full id, from the beginning of one.
Json find_job(ApiClient& session, const std::string& id);

/// Asks again.
void refresh(ApiClient& session, Target& target);
/// The target's jobs as of the last answer.
std::vector<Json> jobs_of(const Target& target);

/// Whether nothing more happens to a job by itself, as the daemon says of it (JOB, or what it answers of its log).
bool has_ended(const Json& job);

/// The first letters of a job's id, as shown in tables; enough for commands to find it.
std::string short_id(const std::string& id);

/// Part of a job that is done, 0 to 1; and seconds to its end, negative where unknown.
double job_fraction(const Json& job);
double job_eta(const Json& job);
/// A number of the job's progress.json; NaN if it is not there.
double progress_number(const Json& job, const char* key);
/// job[key] as text that may be shown (base/text.h: printable); empty if it is missing, null or no text.
std::string text_of(const Json& object, const char* key);

/// job[key] as a whole number; 0 if it is missing, null or no number.
int number_of(const Json& object, const char* key);
/// The time limits of a job, and how much of them is used: "gives way after 10 min; 12 min of 2 h 00 min used"; empty
/// if it has none.
std::string limits_text(const Json& job);

/// Mean S of a run that is done, and of what kind of time it is.
struct MeanOrder {
  double value = 0;
  Steadiness steadiness = Steadiness::kSteady;
};

/// That of a JOB object of the API, from the summary in its directory; none if the job is not done or its summary has
/// no mean S.
std::optional<MeanOrder> mean_order(const Json& job);

/// Jobs in the states that are so, of {state: n}.
int count_of(const Json& counts, bool (*are_so)(JobState));
/// {state: n} as words, what is done and what runs first: "3 done, 2 running, 5 queued".
std::string counts_text(const Json& counts);

}  // namespace shaken::client
