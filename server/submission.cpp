// SPDX-License-Identifier: MIT
#include "server/submission.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/files.h"
#include "run/files/directory.h"
#include "run/files/done.h"
#include "scene/canonical.h"
#include "scene/length.h"
#include "scene/load.h"
#include "scene/nearest.h"
#include "scene/placement.h"
#include "server/queue/job.h"

namespace shaken::server {
namespace {

using nlohmann::json;

constexpr int kMostReplicas = 10'000;
constexpr int kMostAtOnce = 1'000'000;
constexpr int kHighestPriority = 1'000'000;
constexpr int kDeepest = 16;  // of brackets in a body; the scene in it is a text

const std::vector<std::string> kKeys{"text",         "file",         "settings", "replicas", "name",   "priority",
                                     "soft_limit_s", "time_limit_s", "at_most",  "after",    "stop_if"};

std::string text_of(const json& value, const std::string& key) {
  if (!value.is_string()) throw std::invalid_argument("\"" + key + "\" must be a string");
  return value.get<std::string>();
}

bool flag_of(const json& value, const std::string& key) {
  if (!value.is_boolean()) throw std::invalid_argument("\"" + key + "\" must be true or false");
  return value.get<bool>();
}

std::vector<std::string> texts_of(const json& value, const std::string& key) {
  if (!value.is_array()) throw std::invalid_argument("\"" + key + "\" must be an array");
  std::vector<std::string> texts;
  for (const json& text : value) texts.push_back(text_of(text, key));
  return texts;
}

int integer_of(const json& value, const std::string& key, int least, int most) {
  const bool fits = value.is_number_integer() && value >= least && value <= most;
  if (!fits) {
    throw std::invalid_argument("\"" + key + "\" must be an integer from " + std::to_string(least) + " to " +
                                std::to_string(most));
  }
  return value.get<int>();
}

/// Whether brackets outside of texts are nested deeper than `most`.
bool nests_deeper_than(std::string_view text, int most) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_text = !in_text;
    } else if (!in_text && (c == '[' || c == '{') && ++depth > most) {
      return true;
    } else if (!in_text && (c == ']' || c == '}')) {
      --depth;
    }
  }
  return false;
}

/// The body as an object with no other keys than `known`.
json parse_object(std::string_view body, const std::vector<std::string>& known) {
  // A parser needs 80 bytes for each bracket of a body that is nothing else.
  if (nests_deeper_than(body, kDeepest)) {
    throw std::invalid_argument("the body is nested more than " + std::to_string(kDeepest) + " deep");
  }
  json object;
  try {
    object = json::parse(body);
  } catch (const json::exception& problem) {
    throw std::invalid_argument(std::string("the body is not JSON: ") + problem.what());
  }
  if (!object.is_object()) throw std::invalid_argument("the body must be a JSON object");
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      throw std::invalid_argument("unknown key \"" + key + "\"" + scene::did_you_mean(scene::nearest(key, known)));
    }
  }
  return object;
}

/// A time in seconds, as milliseconds; at least one.
std::chrono::milliseconds time_of(const json& value, const std::string& key) {
  constexpr double kLeast = 0.001;
  constexpr double kMost = 1e9;  // more than 30 years
  const bool fits = value.is_number() && value.get<double>() >= kLeast && value.get<double>() <= kMost;
  if (!fits) throw std::invalid_argument("\"" + key + "\" must be a number of seconds from 0.001 to 1e9");
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * value.get<double>()));
}

int priority_of(const json& value) { return integer_of(value, "priority", -kHighestPriority, kHighestPriority); }

}  // namespace

SubmitRequest parse_submit_request(std::string_view body) {
  const json object = parse_object(body, kKeys);
  if (!object.contains("text")) throw std::invalid_argument("\"text\" is missing: a scene or sweep file");

  SubmitRequest request;
  request.text = text_of(object["text"], "text");
  if (object.contains("file")) request.file = text_of(object["file"], "file");
  if (object.contains("settings")) request.settings = texts_of(object["settings"], "settings");
  if (object.contains("replicas")) request.replicas = integer_of(object["replicas"], "replicas", 1, kMostReplicas);
  if (object.contains("priority")) {
    request.priority = priority_of(object["priority"]);
  }
  if (object.contains("soft_limit_s")) request.terms.soft_limit = time_of(object["soft_limit_s"], "soft_limit_s");
  if (object.contains("time_limit_s")) request.terms.time_limit = time_of(object["time_limit_s"], "time_limit_s");
  if (object.contains("at_most")) request.terms.at_most = integer_of(object["at_most"], "at_most", 1, kMostAtOnce);
  if (object.contains("after")) request.after = texts_of(object["after"], "after");
  if (object.contains("stop_if")) {
    const auto rule = StopRule::parse(text_of(object["stop_if"], "stop_if"));
    if (!rule) throw std::invalid_argument("\"stop_if\": " + rule.error().message);
    request.terms.stop_if = *rule;
  }
  if (object.contains("name")) {
    request.name = text_of(object["name"], "name");
    if (const auto problem = scene::name_problem(request.name)) throw std::invalid_argument("\"name\": " + *problem);
    if (const auto problem = scene::id_problem(request.name)) throw std::invalid_argument("\"name\": " + *problem);
  }
  return request;
}

CleanBody parse_clean_request(std::string_view body) {
  const json object = parse_object(body, {"states", "sweep", "older_s", "unknown", "dry_run", "only"});
  CleanBody asked;
  if (object.contains("states")) {
    asked.request.states.clear();
    for (const std::string& word : texts_of(object["states"], "states")) {
      const auto state = job_state(word);
      if (!state || !has_ended(*state)) {
        throw std::invalid_argument("\"states\": '" + word + "' is none of done, failed, timed out, cancelled");
      }
      asked.request.states.push_back(*state);
    }
  }
  if (object.contains("sweep")) asked.sweep = text_of(object["sweep"], "sweep");
  if (object.contains("older_s")) {
    asked.request.older = std::chrono::duration_cast<std::chrono::seconds>(time_of(object["older_s"], "older_s"));
  }
  if (object.contains("unknown")) asked.request.unknown = flag_of(object["unknown"], "unknown");
  if (object.contains("dry_run")) asked.request.dry_run = flag_of(object["dry_run"], "dry_run");
  if (object.contains("only")) {
    const auto ids = texts_of(object["only"], "only");
    asked.request.only.emplace(ids.begin(), ids.end());
  }
  return asked;
}

int parse_priority(std::string_view body) {
  const json object = parse_object(body, {"priority"});
  if (!object.contains("priority")) throw std::invalid_argument("\"priority\" is missing: a whole number");
  return priority_of(object["priority"]);
}

int parse_replicas(std::string_view body) {
  const json object = parse_object(body, {"replicas"});
  if (!object.contains("replicas")) throw std::invalid_argument("\"replicas\" is missing: a whole number");
  return integer_of(object["replicas"], "replicas", 1, kMostReplicas);
}

std::vector<std::string> parse_extension(std::string_view body) {
  static const std::map<std::string, std::string> kPaths{
      {"measure", "time.measure"}, {"order_sem", "until.order_sem"}, {"at_most", "until.at_most"}};
  std::vector<std::string> known;
  known.reserve(kPaths.size());
  for (const auto& [key, path] : kPaths) known.push_back(key);
  std::vector<std::string> settings;
  const json object = parse_object(body, known);
  settings.reserve(object.size());
  for (const auto& [key, value] : object.items()) {
    if (!value.is_string() && !value.is_number()) {
      throw std::invalid_argument("\"" + key + "\" must be a number or a text with a unit");
    }
    settings.push_back(kPaths.at(key) + "=" + (value.is_string() ? value.get<std::string>() : value.dump()));
  }
  if (settings.empty()) throw std::invalid_argument("one of \"measure\", \"order_sem\" and \"at_most\" is needed");
  return settings;
}

scene::Loaded<std::string> extended_scene(const std::string& name, const std::string& scene,
                                          const std::vector<std::string>& settings) {
  const auto plan = scene::load_scene(scene, name, settings);
  if (!plan) {
    std::vector<scene::Problem> problems = plan.error();
    for (scene::Problem& problem : problems) problem.file = name;  // nobody has typed such a setting
    return problems;
  }
  return scene::to_json(*plan).dump(2) + "\n";
}

scene::Loaded<Submission> expand(const SubmitRequest& request, const std::filesystem::path& runs) {
  const std::string name = request.name.empty() ? scene::sweep_name(request.text, request.file) : request.name;
  // before the points, of which there may be many
  if (const auto problem = scene::id_problem(name)) {
    return std::vector{scene::Problem{request.file, 0, 0, "", *problem + "; submit it with another name"}};
  }
  auto sweep = scene::load_runs(request.text, request.file, request.settings, request.replicas);
  if (!sweep) return sweep.error();
  Submission submission{name, request.priority, request.terms, {}, {}};
  submission.terms.executor = sweep->executor;
  submission.terms.settings = scene::to_text(sweep->slurm);
  submission.jobs.reserve(sweep->points.size());
  for (scene::SweepPoint& each : sweep->points) {
    const scene::SweepPoint point = std::move(each);  // of 100,000, what is not needed any more counts
    NewJob job;
    job.id = scene::run_id(point.plan);
    job.scene = scene::to_json(point.plan).dump(2) + "\n";
    job.label = point.label;
    job.parameters = point.parameters.dump();
    job.replica = point.replica;
    job.has_results = run::is_done(run::RunDirectory{runs / job.id}, point.plan);
    submission.jobs.push_back(std::move(job));
    const auto& start = point.plan.start;
    if (start && std::find(submission.starts.begin(), submission.starts.end(), *start) == submission.starts.end()) {
      submission.starts.push_back(*start);
    }
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
  if (!plan) return scene::to_string(plan.error());
  if (scene::run_id(*plan) == id) return "";
  return "its scene in the queue is not the one of this id: it was queued by a version with other physics, or queue.db "
         "is damaged; submit it again";
}

}  // namespace shaken::server
