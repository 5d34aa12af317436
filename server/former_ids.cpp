// SPDX-License-Identifier: MIT
#include "server/former_ids.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "base/files.h"
#include "run/files/former_id.h"
#include "scene/canonical.h"
#include "scene/load.h"

namespace shaken::server {
namespace {

struct Renamed {
  std::string former;
  std::string id;
  int claim = 0;  ///< to the new id: 2 of a job that is done, 1 of one that is to run, 0 of one that nobody waits for
  double length = 0;  ///< simulated seconds
};

int claim_of(JobState state) {
  if (state == JobState::kDone) return 2;
  return has_ended(state) ? 0 : 1;
}

/// Checkpoints and summary carry the id too, and are known by the length that the folder's own scene has.
void renew_files(const std::filesystem::path& folder) {
  const run::RunDirectory directory{folder};
  const auto text = read_file(directory.scene());
  if (!text) return;  // nothing was run there
  const auto plan = scene::load_scene(*text, directory.scene().string());
  if (!plan) return;
  if (auto done = run::renew_id(directory, *plan); !done) spdlog::warn("{}", done.error().message);
}

/// The jobs with an id of former times, those first whose folders matter most.
std::vector<Renamed> renamed_jobs(const Queue& queue) {
  std::vector<Renamed> renamed;
  for (const Job& job : queue.jobs(std::nullopt)) {
    const auto plan = scene::load_scene(queue.scene(job.id), "its scene in the queue");
    if (!plan || scene::scene_hash(*plan) != job.id) continue;  // refused with a reason when it is to start
    renamed.push_back({job.id, scene::run_id(*plan), claim_of(job.state), plan->longest_time()});
  }
  std::stable_sort(renamed.begin(), renamed.end(), [](const Renamed& a, const Renamed& b) {
    return std::tuple(a.claim, a.length) > std::tuple(b.claim, b.length);
  });
  return renamed;
}

}  // namespace

void renew_ids(Queue& queue, const std::filesystem::path& runs) {
  if (!queue.has_former_ids()) return;
  std::vector<std::pair<std::string, std::string>> ids;
  for (const Renamed& job : renamed_jobs(queue)) {
    ids.emplace_back(job.former, job.id);
    std::error_code error;
    if (std::filesystem::exists(runs / job.former, error) && !std::filesystem::exists(runs / job.id, error)) {
      std::filesystem::rename(runs / job.former, runs / job.id, error);
      if (error) spdlog::warn("{} keeps its name: {}", (runs / job.former).string(), error.message());
    }
    renew_files(runs / job.id);
  }
  queue.renew_ids(ids);
  if (!ids.empty()) spdlog::info("{} jobs have new ids, which do not depend on the length of their runs", ids.size());
}

}  // namespace shaken::server
