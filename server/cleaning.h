#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/queue/queue.h"

namespace shaken::server {

/// Which run directories are to go. Without `only`, all that fit.
struct CleanRequest {
  std::vector<JobState> states = states_that(came_to_nothing);  ///< of ended jobs
  std::optional<std::int64_t> sweep;                            ///< its jobs only
  std::chrono::seconds older{0};                                ///< ended, or of unknown runs written last, so long ago
  bool unknown = false;                                         ///< remove runs that no job is known of, too
  bool dry_run = false;                                         ///< only list
  std::optional<std::set<std::string>> only;                    ///< of those that fit, these ids
};

/// A run directory that fits a request.
struct Cleaned {
  std::string id;
  std::optional<Job> job;    ///< none: the queue does not know it
  bool is_imported = false;  ///< a run of rods from a file, which is no job
  std::int64_t bytes = 0;    ///< of its files
  bool removed = false;
  std::string kept;  ///< why it was not removed though that was asked for; or empty
};

/// Lists run directories below `runs`, and removes them unless that is only a dry run. Removed are folders whose name
/// is an id and that nobody has locked; links are neither followed nor removed. A run that was done before it was
/// extended stays, however that ended, unless `states` has done as well. A job whose directory goes becomes
/// cancelled first, "cleaned on request": submitted again, it is done anew.
std::vector<Cleaned> clean(Queue& queue, const std::filesystem::path& runs, const CleanRequest& request);

/// Ids of the run directories below `runs`, in alphabetical order.
std::vector<std::string> run_ids(const std::filesystem::path& runs);

}  // namespace shaken::server
