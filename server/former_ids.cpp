// SPDX-License-Identifier: MIT
#include "server/former_ids.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "scene/canonical.h"
#include "scene/load.h"

namespace shaken::server {
namespace {

struct Renamed {
  std::string former;
  std::string id;
  bool done = false;
  double length = 0;  ///< simulated seconds
};

/// The jobs with an id of former times, those first whose folders matter most.
std::vector<Renamed> renamed_jobs(const Queue& queue) {
  std::vector<Renamed> renamed;
  for (const Job& job : queue.jobs(std::nullopt)) {
    const auto plan = scene::load_scene(queue.scene(job.id), "its scene in the queue");
    if (!plan || scene::scene_hash(*plan) != job.id) continue;  // refused with a reason when it is to start
    renamed.push_back({job.id, scene::run_id(*plan), job.state == JobState::kDone, plan->longest_time()});
  }
  std::stable_sort(renamed.begin(), renamed.end(), [](const Renamed& a, const Renamed& b) {
    return std::tuple(a.done, a.length) > std::tuple(b.done, b.length);
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
    if (!std::filesystem::exists(runs / job.former, error) || std::filesystem::exists(runs / job.id, error)) continue;
    std::filesystem::rename(runs / job.former, runs / job.id, error);
    if (error) spdlog::warn("{} keeps its name: {}", (runs / job.former).string(), error.message());
  }
  queue.renew_ids(ids);
  if (!ids.empty()) spdlog::info("{} jobs have new ids, which do not depend on the length of their runs", ids.size());
}

}  // namespace shaken::server
