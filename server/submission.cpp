// SPDX-License-Identifier: MIT
#include "server/submission.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "run/files/directory.h"
#include "scene/canonical.h"
#include "scene/nearest.h"
#include "scene/placement.h"
#include "server/job.h"

namespace shaken::server {
namespace {

using nlohmann::json;

constexpr int kMostReplicas = 10'000;
constexpr int kHighestPriority = 1'000'000;

const std::vector<std::string> kKeys{"text", "file", "settings", "replicas", "name", "priority"};

std::string text_of(const json& value, const std::string& key) {
  if (!value.is_string()) throw std::invalid_argument("\"" + key + "\" must be a string");
  return value.get<std::string>();
}

int integer_of(const json& value, const std::string& key, int least, int most) {
  const bool fits = value.is_number_integer() && value >= least && value <= most;
  if (!fits) {
    throw std::invalid_argument("\"" + key + "\" must be an integer from " + std::to_string(least) + " to " +
                                std::to_string(most));
  }
  return value.get<int>();
}

std::optional<std::string> name_problem(const std::string& name) {
  if (sweep_number(name)) return "'" + name + "' could be mistaken for a sweep's id";
  return scene::name_problem(name);
}

}  // namespace

SubmitRequest parse_submit_request(std::string_view body) {
  json object;
  try {
    object = json::parse(body);
  } catch (const json::exception& problem) {
    throw std::invalid_argument(std::string("the body is not JSON: ") + problem.what());
  }
  if (!object.is_object()) throw std::invalid_argument("the body must be a JSON object");
  for (const auto& [key, value] : object.items()) {
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      throw std::invalid_argument("unknown key \"" + key + "\"" + scene::did_you_mean(scene::nearest(key, kKeys)));
    }
  }
  if (!object.contains("text")) throw std::invalid_argument("\"text\" is missing: a scene or sweep file");

  SubmitRequest request;
  request.text = text_of(object["text"], "text");
  if (object.contains("file")) request.file = text_of(object["file"], "file");
  if (object.contains("settings")) {
    if (!object["settings"].is_array()) throw std::invalid_argument("\"settings\" must be an array");
    for (const json& setting : object["settings"]) request.settings.push_back(text_of(setting, "settings"));
  }
  if (object.contains("replicas")) request.replicas = integer_of(object["replicas"], "replicas", 1, kMostReplicas);
  if (object.contains("priority")) {
    request.priority = integer_of(object["priority"], "priority", -kHighestPriority, kHighestPriority);
  }
  if (object.contains("name")) {
    request.name = text_of(object["name"], "name");
    if (const auto problem = name_problem(request.name)) throw std::invalid_argument("\"name\": " + *problem);
  }
  return request;
}

scene::Loaded<Submission> expand(const SubmitRequest& request, const std::filesystem::path& runs) {
  const auto sweep = scene::load_runs(request.text, request.file, request.settings, request.replicas);
  if (!sweep.value) return {std::nullopt, sweep.problems};
  Submission submission{request.name.empty() ? sweep.value->name : request.name, request.priority, {}};
  if (const auto problem = name_problem(submission.name)) {
    return {std::nullopt, {scene::Problem{request.file, 0, 0, "", *problem + "; submit it with another name"}}};
  }
  for (const scene::SweepPoint& point : sweep.value->points) {
    NewJob job;
    job.id = scene::run_id(point.plan);
    job.scene = scene::to_json(point.plan).dump(2) + "\n";
    job.label = point.label;
    job.parameters = point.parameters.dump();
    job.replica = point.replica;
    job.results_lost = !std::filesystem::exists(run::RunDirectory{runs / job.id}.summary());
    submission.jobs.push_back(std::move(job));
  }
  return {std::move(submission), {}};
}

}  // namespace shaken::server
