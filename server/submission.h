#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "base/keys/table.h"
#include "scene/keys/run_plan.h"
#include "server/cleaning.h"
#include "server/queue/queue.h"

namespace shaken::server {

/// The body of POST /v1/sweeps.
struct SubmitRequest {
  std::string text;                   ///< of a scene or sweep file
  std::string file = "request";       ///< its name, for messages
  std::vector<std::string> settings;  ///< "path=value"
  std::optional<int> replicas;
  std::string name;                ///< of the sweep; if empty, the name in the text or that of the file
  int priority = 0;                ///< higher ones are started first
  Terms terms;                     ///< but for `after`
  std::vector<std::string> after;  ///< sweeps and jobs, as the user names them
  bool dry_run = false;            ///< only check
};

/// How much the runs of a submission are, together.
struct Extent {
  int fewest_rods = 0, most_rods = 0;  ///< of one run
  double simulated = 0;                ///< [s]
};

/// What goes into the queue.
struct Submission {
  std::string name;
  int priority = 0;
  Terms terms;
  std::vector<NewJob> jobs;
  std::vector<scene::StartState> starts;  ///< runs that they start from and that are none of them, each once
  Extent extent = {};
};

const keys::Table<SubmitRequest>& submit_keys();

/// The body of POST /v1/clean; a sweep is still as the user names it.
struct CleanBody {
  CleanRequest request;
  std::string sweep;
};
const keys::Table<CleanBody>& clean_keys();

/// {"priority": n} and {"replicas": n}.
struct CountBody {
  int n = 0;
};
const keys::Table<CountBody>& priority_keys();
const keys::Table<CountBody>& replicas_keys();

/// {"measure": time, "order_sem": number, "at_most": time}; each may be left out.
struct Extension {
  std::vector<std::string> settings;  ///< that it stands for, "time.measure=600 s"
};
const keys::Table<Extension>& extension_keys();

/// A canonical scene with such settings; `name`, for messages; as canonical text, or all that is wrong with it.
keys::Loaded<std::string> extended_scene(const std::string& name, const std::string& scene,
                                         const std::vector<std::string>& settings);

/// The sweep that a request asks for, or all that is wrong with its text.
/// `runs`: folder of the run directories, where it is looked whether results are still there.
keys::Loaded<Submission> expand(const SubmitRequest& request, const std::filesystem::path& runs);

/// Why no run can start from `start`; empty if nothing is known against it. The run is to be among those of `queue`,
/// and end then, or to have a folder in `runs`.
std::string refuse_start(const scene::StartState& start, const Queue& queue, const std::filesystem::path& runs);

/// Why the scene that the queue has for job `id` is not to be run; empty if it is that job's.
std::string refuse_scene(const std::string& id, const std::string& scene);

/// The jobs of a sweep with `n` replicas of each of its points, or as many as there are if these are more: those that
/// are there, and new ones with further seeds, as if its file had been submitted so. `runs`: folder of the run
/// directories, where it is looked whether results are there. Fails where the seed is swept, or where a scene is of
/// other physics.
Result<std::vector<NewJob>> with_replicas(const Queue& queue, std::int64_t sweep, int n,
                                          const std::filesystem::path& runs);

}  // namespace shaken::server
