#include "client/live/target.h"

#include <fmt/format.h>

#include <initializer_list>
#include <limits>

#include "base/failure.h"
#include "base/files.h"
#include "base/text.h"
#include "run/files/directory.h"

namespace shaken::client {

std::string Target::sweep_id() const {
  return is_sweep ? answer.at("sweep").at("id").get<std::string>() : text_of(answer.at("job"), "sweep");
}

std::string Target::id() const { return answer.at(is_sweep ? "sweep" : "job").at("id").get<std::string>(); }

std::string Target::title() const {
  if (!is_sweep) return "job " + answer.at("job").at("id").get<std::string>();
  const Json& sweep = answer.at("sweep");
  const std::string name = text_of(sweep, "name");
  const std::string id = sweep.at("id").get<std::string>();
  return "sweep " + id + (name.empty() || name == id ? "" : " (" + name + ")");
}

bool is_run_directory(const std::string& id) {
  std::error_code error;
  return std::filesystem::exists(run::RunDirectory{id}.scene(), error);
}

Target find_target(ApiClient& session, const std::string& id) {
  if (id.empty()) throw Failure(ExitCode::kBadInput, "an empty ID names nothing");
  std::string hint;  // the daemon's; a name is more than a shortened id
  for (const bool is_sweep : {true, false}) {
    const std::string folder = is_sweep ? "/v1/sweeps/" : "/v1/jobs/";
    Result<Json> answer = session.find(folder + url_encoded(id));
    if (answer) {
      const std::string full_id = answer->at(is_sweep ? "sweep" : "job").at("id").get<std::string>();
      return {folder + url_encoded(full_id), std::move(answer).value(), is_sweep};
    }
    const std::size_t begin = answer.error().message.find("; did you mean");
    if (hint.empty() && begin != std::string::npos) hint = answer.error().message.substr(begin);
  }
  throw Failure(ExitCode::kBadInput, fmt::format("no sweep or job is called '{}'{}: `shaken status` lists them",
                                                 printable(id), printable(hint)));
}

std::vector<Target> find_targets(ApiClient& session, const std::vector<std::string>& ids) {
  std::vector<Target> targets;
  std::string problems;
  for (const std::string& id : ids) {
    try {
      targets.push_back(find_target(session, id));
    } catch (const Failure& failure) {
      if (failure.code != ExitCode::kBadInput) throw;
      problems += (problems.empty() ? "" : "\n") + std::string(failure.what());
    }
  }
  if (!problems.empty()) throw Failure(ExitCode::kBadInput, problems);
  return targets;
}

Json find_job(ApiClient& session, const std::string& id) {
  const std::vector<Json> jobs = jobs_of(find_target(session, id));
  if (jobs.size() == 1) return jobs.front();  // a sweep of one job is as clear as the job itself
  throw Failure(ExitCode::kBadInput,
                fmt::format("'{}' is a sweep of {} jobs, and this needs one job: `shaken status {}` lists them", id,
                            jobs.size(), id));
}

void refresh(ApiClient& session, Target& target) { target.answer = session.get(target.path); }

std::vector<Json> jobs_of(const Target& target) {
  if (!target.is_sweep) return {target.answer.at("job")};
  const Json& jobs = target.answer.at("jobs");
  return {jobs.begin(), jobs.end()};
}

bool has_ended(const Json& job) { return job.at("ended").get<bool>(); }

std::string short_id(const std::string& id) { return id.substr(0, 8); }

double progress_number(const Json& job, const char* key) {
  const auto progress = job.find("progress");
  if (progress == job.end() || !progress->is_object()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = progress->find(key);
  return value != progress->end() && value->is_number() ? value->get<double>()
                                                        : std::numeric_limits<double>::quiet_NaN();
}

double job_fraction(const Json& job) {
  if (text_of(job, "state") == "done") return 1.0;
  const double fraction = progress_number(job, "sim_time_s") / progress_number(job, "sim_time_total_s");
  return fraction >= 0.0 ? fraction : 0.0;  // NaN too
}

double job_eta(const Json& job) {
  const double eta = progress_number(job, "eta_s");
  return text_of(job, "state") == "running" && eta >= 0.0 ? eta : -1.0;
}

std::string text_of(const Json& object, const char* key) {
  const auto value = object.find(key);
  return value != object.end() && value->is_string() ? printable(value->get<std::string>()) : std::string();
}

int number_of(const Json& object, const char* key) {
  const auto value = object.find(key);
  return value != object.end() && value->is_number() ? value->get<int>() : 0;
}

std::string limits_text(const Json& job) {
  const auto seconds = [&job](const char* key) {
    const auto value = job.find(key);
    return value != job.end() && value->is_number() ? value->get<double>() : 0.0;
  };
  std::string text;
  if (const double soft = seconds("soft_limit_s"); soft > 0) text = "gives way after " + duration_text(soft);
  if (const double hard = seconds("time_limit_s"); hard > 0) {
    text +=
        fmt::format("{}{} of {} used", text.empty() ? "" : "; ", duration_text(seconds("wall_s")), duration_text(hard));
  }
  return text;
}

std::optional<MeanOrder> mean_order(const Json& job) {
  if (text_of(job, "state") != "done") return std::nullopt;
  const auto text = read_file(run::RunDirectory{text_of(job, "directory")}.summary());
  const Json summary = text ? Json::parse(*text, nullptr, false) : Json();
  const Json::json_pointer mean("/order/mean");
  if (!summary.is_object() || !summary.contains(mean) || !summary.at(mean).is_number()) return std::nullopt;
  const Json steady = summary.value("steady", Json(true));  // a summary that does not say is of no present version
  return MeanOrder{summary.at(mean).get<double>(),
                   steadiness_of(steady.is_boolean() ? std::optional(steady.get<bool>()) : std::nullopt)};
}

int count_of(const Json& counts, bool (*are_so)(JobState)) {
  int n = 0;
  for (const std::string& state : words_of(are_so)) n += counts.value(state, 0);
  return n;
}

std::string counts_text(const Json& counts) {
  std::string text;
  using Are = bool (*)(JobState);
  constexpr Are is_done = [](JobState state) { return state == JobState::kDone; };
  for (const Are are_so : std::initializer_list<Are>{is_done, has_worker, is_waiting, came_to_nothing}) {
    for (const std::string& state : words_of(are_so)) {
      const int n = counts.value(state, 0);
      if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, state);
    }
  }
  return text.empty() ? "no jobs" : text;
}

}  // namespace shaken::client
