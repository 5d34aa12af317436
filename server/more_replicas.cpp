#include "server/more_replicas.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "run/files/directory.h"
#include "run/files/done.h"
#include "scene/canonical.h"
#include "scene/load.h"
#include "server/submission.h"

namespace shaken::server {
namespace {

/// One point of a sweep: what its replicas have in common.
struct Point {
  std::string label;
  std::map<int, Job> replicas;  ///< that are there, by their number
};

/// The label of a job without what says which replica it is.
std::string label_of_point(const Job& job) {
  const std::string ending = fmt::format("replica={}", job.replica);
  std::string label = job.label;
  if (!label.ends_with(ending)) return label;
  label.resize(label.size() - ending.size());
  if (label.ends_with(' ')) label.pop_back();
  return label;
}

std::string label_of_replica(const Point& point, int replica, int n) {
  if (n == 1) return point.label;
  return fmt::format("{}{}replica={}", point.label, point.label.empty() ? "" : " ", replica);
}

std::vector<Point> points_of(const std::vector<Job>& jobs) {
  std::vector<Point> points;
  for (const Job& job : jobs) {
    std::string label = label_of_point(job);
    const bool is_next = points.empty() || points.back().label != label || points.back().replicas.contains(job.replica);
    if (is_next) points.push_back({std::move(label), {}});
    points.back().replicas.emplace(job.replica, job);
  }
  return points;
}

/// When runs end from which others of the sweep start [s], by the ids of the first replicas.
std::map<std::string, double> ends_of_stages(const Queue& queue, const std::vector<Point>& points) {
  std::map<std::string, double> ends;
  for (const Point& point : points) {
    const Job& first = point.replicas.begin()->second;
    if (first.starts_from.empty()) continue;
    const auto plan = scene::load_scene(queue.scene(first.id), "job " + first.id);
    if (plan && plan->start) ends.emplace(plan->start->run, plan->start->time);
  }
  return ends;
}

}  // namespace

Result<std::vector<NewJob>> with_replicas(const Queue& queue, std::int64_t sweep, int n,
                                          const std::filesystem::path& runs) {
  std::vector<NewJob> jobs;
  std::map<std::pair<std::string, int>, std::string> ids;  // by the id of a point's first replica, and the replica
  const std::vector<Point> points = points_of(queue.jobs(sweep));
  const std::map<std::string, double> ends = ends_of_stages(queue, points);
  for (const Point& point : points) {
    const auto& [first, known] = *point.replicas.begin();
    const auto parameters = nlohmann::json::parse(known.parameters, nullptr, false);
    if (parameters.is_object() && parameters.contains("time.seed")) {
      return Error{"its seeds are swept: submit its file with more of them"};
    }
    const std::string scene = queue.scene(known.id);
    if (const std::string why = refuse_scene(known.id, scene); !why.empty()) {
      return Error{"job " + known.id + " cannot have replicas: " + why};
    }
    auto plan = scene::load_scene(scene, "job " + known.id);
    if (!plan) return Error{keys::to_string(plan.error())};
    const std::uint64_t seed = plan->system.seed - static_cast<std::uint64_t>(first - 1);
    const std::string start = plan->start ? plan->start->run : "";
    // a stage that was extended since the next one started from it is not for its replicas
    if (const auto end = ends.find(known.id); end != ends.end() && !plan->until) {
      plan->measure_time = end->second - plan->steady.value_or(0);
    }
    const int n_all = std::max(n, point.replicas.rbegin()->first);
    for (int replica = 1; replica <= n_all; ++replica) {
      NewJob job;
      job.label = label_of_replica(point, replica, n_all);
      job.parameters = known.parameters;
      job.replica = replica;
      if (const auto there = point.replicas.find(replica); there != point.replicas.end()) {
        job.id = there->second.id;
        job.starts_from = there->second.starts_from;
        job.scene = queue.scene(job.id);
      } else {
        plan->system.seed = seed + static_cast<std::uint64_t>(replica - 1);
        if (plan->start) {
          const auto stage = ids.find({start, replica});
          job.starts_from = plan->start->run = stage == ids.end() ? start : stage->second;
          job.starts_at = plan->start->time;
        }
        job.id = scene::run_id(*plan);
        job.scene = scene::to_json(*plan).dump(2) + "\n";
        job.has_results = run::is_done(run::RunDirectory{runs / job.id}, *plan);
        if (plan->start && queue.job(job.starts_from)) {
          if (const std::string why = refuse_start(*plan->start, queue, runs); !why.empty()) return Error{why};
        }
      }
      ids[{known.id, replica}] = job.id;
      jobs.push_back(std::move(job));
    }
  }
  return jobs;
}

}  // namespace shaken::server
