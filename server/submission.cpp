#include "server/submission.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "base/files.h"
#include "run/files/directory.h"
#include "run/files/done.h"
#include "scene/canonical.h"
#include "scene/length.h"
#include "scene/load.h"
#include "scene/placement.h"
#include "server/queue/job.h"

namespace shaken::server {
namespace {

using keys::at, keys::Form, keys::plain, keys::text, keys::texts, keys::Value, keys::whole;

constexpr int kMostReplicas = 10'000;
constexpr int kMostAtOnce = 1'000'000;
constexpr int kHighestPriority = 1'000'000;

/// A time, which the daemon keeps in milliseconds: at least one, and up to 30 years.
auto seconds(const std::string& key, auto access, const std::string& doc) {
  return derived(keys::quantity(key, access, keys::Dimension::kTime, 0.001, 1e9, doc), "none");
}

auto required(auto row) {
  row.required = true;
  row.fallback_note = "must be given";
  return row;
}

std::vector<keys::Key<SubmitRequest>> rows_of_submission() {
  using Request = SubmitRequest;
  auto name = derived(text("name", at<&Request::name>, "Name of the sweep."), "that in the text, or of the file");
  name.problem = [](const std::string& word) {
    const auto problem = scene::name_problem(word);
    return problem ? problem : scene::id_problem(word);
  };
  keys::Key<Request> stop_if{
      {.path = "stop_if", .form = Form::kText, .doc = "Rule by which queued jobs are held: `failed>10%`."}};
  stop_if.problem = [](const std::string& word) -> std::optional<std::string> {
    const auto rule = StopRule::parse(word);
    return rule ? std::nullopt : std::optional(rule.error().message);
  };
  stop_if.store = [](Request& request, const Value& word) {
    request.terms.stop_if = *StopRule::parse(std::get<std::string>(word));
  };
  return {required(text("text", at<&Request::text>, "A scene or sweep file.")),
          text("file", at<&Request::file>, "Its name, for messages."),
          texts("settings", at<&Request::settings>, "Changes to the scene, each `path=value`."),
          whole("replicas", at<&Request::replicas>, 1, kMostReplicas, "Runs of each point."),
          name,
          whole("priority", at<&Request::priority>, -kHighestPriority, kHighestPriority, "Higher ones start first."),
          seconds("soft_limit_s", at<&Request::terms, &Terms::soft_limit>, "Wall time of an attempt."),
          seconds("time_limit_s", at<&Request::terms, &Terms::time_limit>, "Wall time of all attempts."),
          derived(whole("at_most", at<&Request::terms, &Terms::at_most>, 1, kMostAtOnce, "Jobs that run at once."),
                  "any number"),
          texts("after", at<&Request::after>, "Sweeps and jobs that must be done first."),
          stop_if,
          keys::on_or_off("dry_run", at<&Request::dry_run>, "Only checks.")};
}

std::vector<keys::Key<CleanBody>> rows_of_cleaning() {
  using Body = CleanBody;
  return {
      {{.path = "states",
        .form = Form::kTexts,
        .names = words_of(has_ended),
        .fallback_note = fmt::format("{}", fmt::join(words_of(came_to_nothing), ", ")),
        .doc = "States of the jobs."},
       {},
       [](Body& body, const Value& words) {
         body.request.states.clear();
         for (const std::string& word : std::get<std::vector<std::string>>(words)) {
           body.request.states.push_back(*job_state(word));
         }
       }},
      derived(text("sweep", at<&Body::sweep>, "Its jobs only, by its id or name."), "all"),
      seconds("older_s", at<&Body::request, &CleanRequest::older>, "Ended so long ago."),
      keys::on_or_off("unknown", at<&Body::request, &CleanRequest::unknown>, "Runs that the queue does not know, too."),
      keys::on_or_off("dry_run", at<&Body::request, &CleanRequest::dry_run>, "Only lists."),
      {{.path = "only", .form = Form::kTexts, .fallback_note = "all", .doc = "Ids of the jobs."},
       {},
       [](Body& body, const Value& words) {
         const auto& ids = std::get<std::vector<std::string>>(words);
         body.request.only.emplace(ids.begin(), ids.end());
       }},
  };
}

/// The setting at `path` of a scene, as it is written.
keys::Key<Extension> setting(const std::string& key, const std::string& path) {
  return {
      {.path = key, .form = Form::kText, .may_look_like_number = true, .expected = "a number or a text with a unit"},
      {},
      [path](Extension& extension, const Value& value) {
        extension.settings.push_back(path + "=" + std::get<std::string>(value));
      }};
}

}  // namespace

const keys::Table<SubmitRequest>& submit_keys() {
  static const keys::Table<SubmitRequest> table(rows_of_submission());
  return table;
}

const keys::Table<CleanBody>& clean_keys() {
  static const keys::Table<CleanBody> table(rows_of_cleaning());
  return table;
}

const keys::Table<CountBody>& priority_keys() {
  static const keys::Table<CountBody> table(
      {required(whole("priority", at<&CountBody::n>, -kHighestPriority, kHighestPriority, "A whole number."))});
  return table;
}

const keys::Table<CountBody>& replicas_keys() {
  static const keys::Table<CountBody> table(
      {required(whole("replicas", at<&CountBody::n>, 1, kMostReplicas, "A whole number."))});
  return table;
}

const keys::Table<Extension>& extension_keys() {
  static const keys::Table<Extension> table({setting("measure", "time.measure"),
                                             setting("order_sem", "until.order_sem"),
                                             setting("at_most", "until.at_most")});
  return table;
}

keys::Loaded<std::string> extended_scene(const std::string& name, const std::string& scene,
                                         const std::vector<std::string>& settings) {
  const auto plan = scene::load_scene(scene, name, settings);
  if (!plan) {
    std::vector<keys::Problem> problems = plan.error();
    for (keys::Problem& problem : problems) problem.file = name;  // nobody has typed such a setting
    return problems;
  }
  return scene::to_json(*plan).dump(2) + "\n";
}

keys::Loaded<Submission> expand(const SubmitRequest& request, const std::filesystem::path& runs) {
  const std::string name = request.name.empty() ? scene::sweep_name(request.text, request.file) : request.name;
  // before the points, of which there may be many
  if (const auto problem = scene::id_problem(name)) {
    return std::vector{keys::Problem{request.file, 0, 0, "", *problem + "; submit it with another name"}};
  }
  auto sweep = SHAKEN_TRY(scene::load_runs(request.text, request.file, request.settings, request.replicas));
  Submission submission{name, request.priority, request.terms, {}, {}, {}};
  Extent& extent = submission.extent;
  extent.fewest_rods = std::numeric_limits<int>::max();
  submission.terms.executor = sweep.executor;
  submission.terms.settings = scene::to_text(sweep.slurm);
  submission.jobs.reserve(sweep.points.size());
  std::unordered_map<std::string, double> ends, ended;  // of these runs, by id; and of those that went on to another
  for (scene::SweepPoint& each : sweep.points) {
    const scene::SweepPoint point = std::move(each);  // of 100,000, what is not needed any more counts
    NewJob job;
    job.id = scene::run_id(point.plan);
    job.scene = scene::to_json(point.plan).dump(2) + "\n";
    job.label = point.label;
    job.parameters = point.parameters.dump();
    job.replica = point.replica;
    const run::RunDirectory directory{runs / job.id};
    job.has_results = run::is_done(directory, point.plan);
    ends.emplace(job.id, point.plan.total_time());
    if (job.has_results == true && !point.plan.until) {
      const std::optional<Tick> end = run::done_tick(directory, job.id);
      if (end && *end != scene::total_ticks(point.plan)) ended.emplace(job.id, *end * point.plan.system.dt);
    }
    extent.fewest_rods = std::min(extent.fewest_rods, point.plan.system.n_all_rods());
    extent.most_rods = std::max(extent.most_rods, point.plan.system.n_all_rods());
    extent.simulated += point.plan.total_time();
    if (const auto& start = point.plan.start) {
      job.starts_from = start->run;
      job.starts_at = start->time;
      const auto end = ends.find(start->run);
      if (end != ends.end() && end->second != start->time) {
        return std::vector{keys::Problem{
            request.file, 0, 0, "/sweep",
            fmt::format("run {} is to end at {:.10g} s, and another is to start from it at {:.10g} s: stages that say "
                        "the same from the start on must last equally long",
                        start->run, end->second, start->time)}};
      }
      if (const auto other = ended.find(start->run); other != ended.end()) {
        return std::vector{keys::Problem{
            request.file, 0, 0, "/sweep",
            fmt::format("run {} went on to {:.10g} s, where its last state is kept, and another is to start from it at "
                        "{:.10g} s: start from there, or clean that run first",
                        start->run, other->second, start->time)}};
      }
      if (end == ends.end() && !std::count(submission.starts.begin(), submission.starts.end(), *start)) {
        submission.starts.push_back(*start);
      }
    }
    submission.jobs.push_back(std::move(job));
  }
  return submission;
}

std::string refuse_start(const scene::StartState& start, const Queue& queue, const std::filesystem::path& runs) {
  const run::RunDirectory directory{runs / start.run};
  const bool queued = queue.job(start.run).has_value();
  const Result<std::string> kept = queued ? queue.scene(start.run) : read_file(directory.scene());
  if (!kept) {
    return fmt::format("no run {} is known here; submit it first, or take the id of one that is (`shaken status`)",
                       start.run);
  }
  std::error_code ignored;
  if (!queued && std::filesystem::exists(directory.imported(), ignored)) {
    if (start.time == 0) return "";
    return fmt::format("the rods of run {} are imported: set start.time to 0, not {:.10g} s", start.run, start.time);
  }
  const auto plan = scene::load_scene(*kept, "its scene");
  if (!plan) return "";
  const double dt = plan->system.dt;
  const Tick asked = std::llround(start.time / dt);
  if (plan->until) {  // how long it takes is known only once it is done
    const std::optional<Tick> end = run::done_tick(directory, start.run);
    if (end ? asked == *end : start.time <= plan->longest_time()) return "";
    return fmt::format("run {} {} {:.10g} s, so it has no state at start.time {:.10g} s", start.run,
                       end ? "ended at" : "ends at the latest at",
                       end ? static_cast<double>(*end) * dt : plan->longest_time(), start.time);
  }
  const Tick end = scene::total_ticks(*plan);
  if (end == asked) return "";
  return fmt::format("run {} ends at {:.10g} s, where its last state is kept, not at start.time {:.10g} s", start.run,
                     static_cast<double>(end) * dt, start.time);
}

std::string refuse_scene(const std::string& id, const std::string& scene) {
  const auto plan = scene::load_scene(scene, "its scene in the queue");
  if (!plan) return keys::to_string(plan.error());
  if (scene::run_id(*plan) == id) return "";
  return "its scene in the queue is not the one of this id: it was queued by a version with other physics, or queue.db "
         "is damaged; submit it again";
}

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
