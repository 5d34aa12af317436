#include "server/api.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>
#include <span>
#include <stdexcept>

#include "base/keys/nearest.h"
#include "base/text.h"
#include "run/files/directory.h"
#include "server/answers.h"
#include "server/cleaning.h"
#include "server/submission.h"

namespace shaken::server {
namespace {

/// What a request gets.
struct Answer {
  Json json;
  int status = 200;
  std::string allow{};  ///< methods that the path has, with 405
};

/// The request cannot be met; becomes the answer.
struct Refusal : std::runtime_error {
  Refusal(int code, const std::string& message, std::vector<keys::Problem> found = {})
      : std::runtime_error(printable(message, Lines::kMany)), status(code), problems(std::move(found)) {}
  int status;
  std::vector<keys::Problem> problems;  ///< of a body, all of them
};

constexpr std::int64_t kLogSliceBytes = 1 << 20;
constexpr int kMostCandidates = 10;    // named when a shortened id fits several jobs
constexpr int kMostCompared = 10'000;  // ids searched for the nearest

/// What a body says.
template <class T>
T parsed(const keys::Table<T>& keys, const std::string& body) {
  auto record = keys.read(body, "body");
  if (!record) throw Refusal(400, to_string(record.error().front()), record.error());
  return *std::move(record);
}

/// A request whose path has been matched.
struct Call {
  const http::Request& request;
  std::string id;  ///< what stands for ID in the path

  std::optional<std::string> parameter(const std::string& name) const {
    const auto found = request.query.find(name);
    if (found == request.query.end() || found->second.empty()) return std::nullopt;
    return found->second;
  }
};

/// What answers the requests of each route.
struct Handlers {
  Queue& queue;
  const DaemonInfo& info;

  struct Route {
    const char* method;
    const char* pattern;     ///< "ID" stands for any one part
    const char* parameters;  ///< allowed after '?', separated by blanks
    Answer (Handlers::*handler)(const Call&) const;

    /// What stands for ID (empty if the pattern has none); nothing if the path does not match.
    std::optional<std::string> match(const std::string& path) const {
      const auto wanted = split(pattern, '/');
      const auto parts = split(path, '/');
      if (parts.size() != wanted.size()) return std::nullopt;
      std::string id;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (wanted[i] == "ID") {
          id = parts[i];
        } else if (wanted[i] != parts[i]) {
          return std::nullopt;
        }
      }
      return id;
    }
  };

  static std::span<const Route> routes() {
    static constexpr Route kRoutes[] = {
        {"GET", "/v1/status", "", &Handlers::status},
        {"POST", "/v1/sweeps", "", &Handlers::submit},
        {"GET", "/v1/sweeps", "", &Handlers::list_sweeps},
        {"GET", "/v1/sweeps/ID", "", &Handlers::show_sweep},
        {"POST", "/v1/sweeps/ID/cancel", "", &Handlers::control},
        {"POST", "/v1/sweeps/ID/hold", "", &Handlers::control},
        {"POST", "/v1/sweeps/ID/resume", "", &Handlers::control},
        {"POST", "/v1/sweeps/ID/retry", "", &Handlers::control},
        {"POST", "/v1/sweeps/ID/priority", "", &Handlers::control},
        {"POST", "/v1/sweeps/ID/extend", "", &Handlers::extend},
        {"POST", "/v1/sweeps/ID/replicas", "", &Handlers::add_replicas},
        {"GET", "/v1/jobs", "sweep state", &Handlers::list_jobs},
        {"GET", "/v1/jobs/ID", "", &Handlers::show_job},
        {"GET", "/v1/jobs/ID/log", "offset", &Handlers::show_log},
        {"GET", "/v1/jobs/ID/history", "", &Handlers::show_history},
        {"POST", "/v1/jobs/ID/cancel", "", &Handlers::control},
        {"POST", "/v1/jobs/ID/hold", "", &Handlers::control},
        {"POST", "/v1/jobs/ID/resume", "", &Handlers::control},
        {"POST", "/v1/jobs/ID/retry", "", &Handlers::control},
        {"POST", "/v1/jobs/ID/priority", "", &Handlers::control},
        {"POST", "/v1/jobs/ID/extend", "", &Handlers::extend},
        {"GET", "/v1/results", "sweep state since", &Handlers::results},
        {"POST", "/v1/clean", "", &Handlers::clean},
    };
    return kRoutes;
  }

  static Answer problems_answer(std::span<const keys::Problem> found) {
    std::string sentence = keys::to_string(found.front());
    if (found.size() > 1) sentence = std::to_string(found.size()) + " problems; the first: " + sentence;
    return {{{"error", sentence}, {"problems", keys::to_json(found)}}, 422};
  }

  /// Whether the path is that of a sweep, and not of a job.
  static bool in_sweep(const Call& call) { return call.request.path.starts_with("/v1/sweeps/"); }

  Answer dispatch(const http::Request& request) const {
    const std::string method = request.method == "HEAD" ? "GET" : request.method;
    std::string allowed;
    for (const Route& route : routes()) {
      const auto id = route.match(request.path);
      if (!id) continue;
      if (route.method != method) {
        allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
        continue;
      }
      const auto known = split(route.parameters, ' ');
      for (const auto& [name, value] : request.query) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
          throw Refusal(400, "unknown parameter '" + name + "'" + keys::did_you_mean(keys::nearest(name, known)));
        }
      }
      return (this->*route.handler)({request, *id});
    }
    if (!allowed.empty()) {
      return {{{"error", request.path + " does not know " + method + ", only " + allowed}}, 405, allowed};
    }
    std::vector<std::string> known;
    for (const Route& route : routes()) known.push_back(std::string(route.method) + " " + route.pattern);
    return {{{"error", "no such path: " + request.path + "; see docs/protocol.md"}, {"routes", known}}, 404};
  }

  Answer status(const Call&) const {
    return {{{"version", info.version},
             {"api", 1},
             {"pid", info.pid},
             {"root", info.root.string()},
             {"host", info.host},
             {"uptime_s", info.uptime()},
             {"slots", info.slots},
             {"lcm", {{"url", info.lcm_url}, {"ok", info.lcm_ok}, {"message", info.lcm_message}}},
             {"relay", info.relay_url.empty() ? Json(nullptr) : Json(info.relay_url)},
             {"jobs", counts_report(queue.counts())}}};
  }

  Answer submit(const Call& call) const {
    SubmitRequest request = parsed(submit_keys(), call.request.body);
    for (const std::string& word : request.after) request.terms.after.push_back(find_target(word));
    auto submission = expand(request, info.runs());
    if (!submission) return problems_answer(submission.error());
    std::vector<keys::Problem> problems;
    for (const scene::StartState& start : submission->starts) {
      std::string reason = refuse_start(start, queue, info.runs());
      if (!reason.empty()) problems.push_back({request.file, 0, 0, "/start", std::move(reason)});
    }
    if (!problems.empty()) return problems_answer(problems);
    if (request.dry_run) {
      queue.check(submission->jobs, submission->terms);
      return checked(*submission);
    }
    return submitted(submission->name, submission->priority, std::move(submission->jobs), submission->terms);
  }

  /// What a submission would put into the queue.
  static Answer checked(const Submission& submission) {
    const auto n_done = std::count_if(submission.jobs.begin(), submission.jobs.end(),
                                      [](const NewJob& job) { return job.has_results.value_or(false); });
    const Extent& extent = submission.extent;
    return {{{"name", submission.name},
             {"n_jobs", submission.jobs.size()},
             {"n_done", n_done},
             {"n_rods", {extent.fewest_rods, extent.most_rods}},
             {"simulated_s", extent.simulated}}};
  }

  Answer add_replicas(const Call& call) const {
    const int n = parsed(replicas_keys(), call.request.body).n;
    const Sweep sweep = find_sweep(call.id);
    auto jobs = with_replicas(queue, sweep.id, n, info.runs());
    if (!jobs) throw Refusal(409, jobs.error().message);
    Terms terms{.at_most = sweep.at_most, .executor = sweep.executor, .settings = sweep.settings};
    int priority = 0;
    if (const std::vector<Job> present = queue.jobs(sweep.id); !present.empty()) {  // jobs keep these, not the sweep
      terms.soft_limit = present.front().soft_limit;
      terms.time_limit = present.front().time_limit;
      priority = present.front().priority;
    }
    for (const std::string& word : sweep.after) terms.after.push_back(target_named(word));
    if (const auto rule = StopRule::parse(sweep.stop_if)) terms.stop_if = *rule;
    return submitted(sweep.name, priority, *std::move(jobs), terms);
  }

  /// Puts jobs into the queue and tells what became of them.
  Answer submitted(const std::string& name, int priority, std::vector<NewJob> jobs, const Terms& terms) const {
    const Submitted submitted = queue.submit(name, priority, jobs, terms);
    spdlog::info("sweep {} '{}': {} jobs, {} new, {} found done, {} queued again", sweep_word(submitted.sweep), name,
                 submitted.counts.total(), submitted.n_new, submitted.n_found, submitted.n_requeued);
    jobs = {};  // their scenes and the answer need not be in memory together
    Json counts = counts_report(submitted.counts);
    counts["new"] = submitted.n_new;
    counts["requeued"] = submitted.n_requeued;
    counts["extended"] = submitted.n_extended;
    counts["found"] = submitted.n_found;
    return {{{"sweep", report(*queue.sweep(submitted.sweep))},
             {"jobs", report(queue.jobs(submitted.sweep))},
             {"counts", counts}},
            submitted.created ? 201 : 200};
  }

  Answer list_sweeps(const Call&) const {
    Json sweeps = Json::array();
    const Line line = this->line();
    for (const Sweep& sweep : queue.sweeps()) sweeps.push_back(report(sweep, line));
    return {{{"sweeps", sweeps}}};
  }

  Answer show_sweep(const Call& call) const {
    const Sweep sweep = find_sweep(call.id);
    return {{{"sweep", report(sweep)}, {"jobs", report(queue.jobs(sweep.id))}}};
  }

  Answer list_jobs(const Call& call) const { return {{{"jobs", report(find_jobs(call))}}}; }

  Answer show_job(const Call& call) const { return {{{"job", job_report(find_job(call.id), info.runs())}}}; }

  /// A parameter of the path that counts something; 0 if it is not there. `meaning` is for the refusal.
  static std::int64_t count_in(const Call& call, const std::string& parameter, const std::string& meaning) {
    const auto text = call.parameter(parameter);
    if (!text) return 0;
    const auto count = number_in<std::int64_t>(*text);
    if (!count || *count < 0) throw Refusal(400, parameter + ": '" + *text + "' is not " + meaning);
    return *count;
  }

  Answer show_log(const Call& call) const {
    const Job job = find_job(call.id);
    const std::int64_t offset = count_in(call, "offset", "a number of bytes");
    const LogSlice slice = read_slice(run::RunDirectory{info.runs() / job.id}.log(), offset, kLogSliceBytes);
    return {
        {{"text", slice.text}, {"offset", slice.next}, {"state", to_word(job.state)}, {"ended", has_ended(job.state)}}};
  }

  Answer show_history(const Call& call) const {
    Json changes = Json::array();
    const Job job = find_job(call.id);
    for (const Change& change : queue.history(job.id)) {
      changes.push_back({{"utime", change.utime},
                         {"from", change.from},
                         {"to", change.to},
                         {"attempt", change.attempt},
                         {"cause", change.cause}});
    }
    return {{{"job", job_report(job, info.runs())}, {"changes", changes}}};
  }

  Answer extend(const Call& call) const {
    const std::vector<std::string> settings = parsed(extension_keys(), call.request.body).settings;
    if (settings.empty()) throw Refusal(400, "one of \"measure\", \"order_sem\" and \"at_most\" is needed");
    const auto jobs = in_sweep(call) ? queue.jobs(find_sweep(call.id).id) : std::vector{find_job(call.id)};
    std::vector<std::pair<std::string, std::string>> scenes;
    std::vector<keys::Problem> problems;  // of the first job that cannot go on so
    Json refused = Json::array();
    for (const Job& job : jobs) {
      const std::string present = queue.scene(job.id);
      std::string why = refuse_scene(job.id, present);
      const std::vector<std::string> next = queue.starting_from(job.id);
      if (why.empty() && !next.empty()) why = "job " + next.front() + " is to start from its end";
      if (why.empty()) {
        const auto longer = extended_scene("job " + job.id, present, settings);
        if (longer) {
          scenes.emplace_back(job.id, *longer);
          continue;
        }
        if (problems.empty()) problems = longer.error();
        why = longer.error().front().message;
      }
      refused.push_back({{"job", job.id}, {"reason", why}});
    }
    if (scenes.empty() && !refused.empty()) {
      if (!problems.empty()) return problems_answer(problems);
      throw Refusal(409, "job " + refused[0]["job"].get<std::string>() +
                             " cannot be extended: " + refused[0]["reason"].get<std::string>());
    }
    Json answer = {{"extended", queue.extend(scenes)}};
    if (!refused.empty()) answer["refused"] = refused;
    return {answer};
  }

  /// Answers "/v1/jobs/ID/ACTION" and "/v1/sweeps/ID/ACTION".
  Answer control(const Call& call) const {
    const auto parts = split(call.request.path, '/');
    const std::string& action = parts.back();
    const Target target = in_sweep(call) ? Target(find_sweep(call.id).id) : Target(find_job(call.id).id);
    const auto answer = [](const char* changed, int n) { return Answer{{{changed, n}}}; };
    if (action == "priority") {
      const int priority = parsed(priority_keys(), call.request.body).n;
      return answer("changed", queue.set_priority(target, priority));
    }
    if (action == "cancel") return answer("cancelled", queue.cancel(target));
    if (action == "hold") return answer("held", queue.hold(target));
    if (action == "resume") return answer("resumed", queue.resume(target));
    return answer("retried", queue.retry(target));
  }

  Answer results(const Call& call) const {
    Json rows = Json::array();
    const std::int64_t since = count_in(call, "since", "a time in microseconds");
    for (const Job& job : find_jobs(call)) {
      if (job.finished >= since) rows.push_back(result_row(job, info.runs()));
    }
    return {{{"rows", rows}}};
  }

  Answer clean(const Call& call) const {
    auto [request, sweep] = parsed(clean_keys(), call.request.body.empty() ? "{}" : call.request.body);
    if (!sweep.empty()) request.sweep = find_sweep(sweep).id;
    Json runs = Json::array();
    std::int64_t bytes = 0;
    for (const Cleaned& run : server::clean(queue, info.runs(), request)) {
      const bool is_known = run.job.has_value();
      runs.push_back({{"id", run.id},
                      {"known", is_known},
                      {"state", is_known          ? Json(to_word(run.job->state))
                                : run.is_imported ? Json("imported")
                                                  : Json(nullptr)},
                      {"label", is_known ? run.job->label : ""},
                      {"sweep", is_known ? Json(sweep_word(run.job->sweep)) : Json(nullptr)},
                      {"finished_utime", is_known ? run.job->finished : 0},
                      {"bytes", run.bytes},
                      {"removed", run.removed},
                      {"kept", run.kept}});
      if (run.removed || (request.dry_run && (is_known || request.unknown))) bytes += run.bytes;
    }
    return {{{"runs", runs}, {"bytes", bytes}}};
  }

  Sweep find_sweep(const std::string& word) const {
    std::optional<Sweep> sweep;
    if (const auto id = sweep_number(word)) sweep = queue.sweep(*id);
    if (!sweep) sweep = queue.sweep_named(word);
    if (sweep) return *sweep;

    std::set<std::string> known;
    for (const Sweep& candidate : queue.sweeps()) known.insert({sweep_word(candidate.id), candidate.name});
    const std::vector<std::string> words(known.begin(), known.end());
    throw Refusal(404, words.empty() ? "no sweep '" + word + "': none has been submitted yet"
                                     : "no sweep '" + word + "'" + keys::did_you_mean(keys::nearest(word, words)));
  }

  Job find_job(const std::string& prefix) const {
    const auto ids = queue.ids_beginning_with(prefix, kMostCandidates + 1);
    if (ids.size() == 1) return *queue.job(ids.front());
    if (ids.size() > 1) {
      std::string message = "'" + prefix + "' fits several jobs: ";
      for (std::size_t i = 0; i < ids.size(); ++i)
        message += (i > 0 ? ", " : "") + (i < kMostCandidates ? ids[i] : "...");
      throw Refusal(409, message);
    }
    // A shortened id is compared with ids that are shortened alike.
    const auto all = queue.ids_beginning_with("", kMostCompared);
    std::vector<std::string> shortened;
    shortened.reserve(all.size());
    for (const std::string& id : all) shortened.push_back(id.substr(0, prefix.size()));
    const auto near = std::find(shortened.begin(), shortened.end(), keys::nearest(prefix, shortened));
    const std::string hint = near == shortened.end() ? "" : all[static_cast<std::size_t>(near - shortened.begin())];
    throw Refusal(404, all.empty() ? "no job '" + prefix + "': none has been submitted yet"
                                   : "no job '" + prefix + "'" + keys::did_you_mean(hint));
  }

  /// A sweep by its id or name, or else a job.
  Target find_target(const std::string& word) const {
    try {
      return find_sweep(word).id;
    } catch (const Refusal& no_sweep) {
      if (!queue.ids_beginning_with(word, 1).empty()) return find_job(word).id;
      throw Refusal(404, "no sweep or job is called '" + word + "'");
    }
  }

  std::vector<Job> find_jobs(const Call& call) const {
    std::optional<std::int64_t> sweep;
    std::optional<JobState> state;
    if (const auto word = call.parameter("sweep")) sweep = find_sweep(*word).id;
    if (const auto word = call.parameter("state")) {
      state = job_state(*word);
      if (!state) {
        std::string known;
        for (const JobStateRow& row : kJobStates) known += (known.empty() ? "" : ", ") + std::string(row.word);
        throw Refusal(400, "state: '" + *word + "' is none of " + known);
      }
    }
    return queue.jobs(sweep, state);
  }

  Line line() const { return line_of(queue.work_ahead(), queue.active(), info.runs()); }

  Json report(const Sweep& sweep) const { return report(sweep, line()); }

  Json report(const Sweep& sweep, const Line& line) const {
    Sweep now = sweep;
    SweepWork work;
    const std::vector<Job> begun = queue.begun(now, work);
    return sweep_report(now, begun, work, line, info.slots, info.runs());
  }

  Json report(std::span<const Job> jobs) const {
    Json reports = Json::array();
    for (const Job& job : jobs) reports.push_back(job_report(job, info.runs()));
    return reports;
  }
};

}  // namespace

http::Reply Api::handle(const http::Request& request) const {
  const auto refuse = [](int status, const std::string& message) {
    return http::Reply{status, to_text({{"error", message}}), ""};
  };
  try {
    const Answer answer = Handlers{queue_, info_}.dispatch(request);
    return {answer.status, to_text(answer.json), answer.allow};
  } catch (const Refusal& refusal) {
    if (!refusal.problems.empty())
      return {refusal.status, to_text(Handlers::problems_answer(refusal.problems).json), ""};
    return refuse(refusal.status, refusal.what());
  } catch (const Conflict& conflict) {
    return refuse(409, conflict.what());
  } catch (const StorageError& problem) {
    spdlog::error("{} {}: {}", request.method, printable(request.path), problem.what());
    return refuse(507, std::string("the queue cannot be read or written: ") + problem.what());
  } catch (const std::exception& problem) {
    spdlog::error("{} {}: {}", request.method, printable(request.path), problem.what());
    return refuse(500, std::string("an error inside shakend: ") + problem.what());
  }
}

}  // namespace shaken::server
