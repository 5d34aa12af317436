// SPDX-License-Identifier: MIT
#include "client/paper/run_set.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/failure.h"
#include "base/files.h"
#include "client/replicas.h"
#include "client/results.h"
#include "run/files/directory.h"

namespace shaken::client {
namespace {

std::shared_ptr<const Json> read_json(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text) throw Failure(ExitCode::kFailed, text.error().message);
  Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object()) throw Failure(ExitCode::kFailed, file.string() + " is no JSON object");
  return std::make_shared<const Json>(std::move(json));
}

/// The member at a dotted path; null if there is none.
const Json* find(const Json& json, const std::string& path) {
  const Json* at = &json;
  std::size_t begin = 0;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    if (!at->is_object() || !at->contains(key)) return nullptr;
    at = &at->at(key);
    begin = end + 1;
  }
  return at;
}

double number_or_nan(const Json* json) {
  return json != nullptr && json->is_number() ? json->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// The word of a flag; null or absent: unknown.
Steadiness steadiness_of(const Json* flag) {
  if (flag == nullptr || !flag->is_boolean()) return Steadiness::kUnknown;
  return flag->get<bool>() ? Steadiness::kSteady : Steadiness::kRelaxing;
}

bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)}); }

}  // namespace

bool Quantity::is_known() const { return std::isfinite(value); }

Quantity exactly(double value) { return {value, 0, Steadiness::kSteady}; }

Steadiness worse(Steadiness a, Steadiness b) {
  for (const Steadiness bad : {Steadiness::kRelaxing, Steadiness::kUnknown}) {
    if (a == bad || b == bad) return bad;
  }
  return Steadiness::kSteady;
}

FinishedRun::FinishedRun(std::filesystem::path directory, Json parameters)
    : directory_(std::move(directory)), parameters_(std::move(parameters)) {
  const run::RunDirectory files{directory_};
  scene_ = read_json(files.scene());
  summary_ = read_json(files.summary());
}

FinishedRun::FinishedRun(Json scene, Json summary, run::Observables observables, Json parameters)
    : parameters_(std::move(parameters)),
      scene_(std::make_shared<const Json>(std::move(scene))),
      summary_(std::make_shared<const Json>(std::move(summary))),
      observables_(std::make_shared<const run::Observables>(std::move(observables))) {}

double FinishedRun::number(const std::string& path) const {
  if (parameters_.contains(path)) return number_or_nan(&parameters_.at(path));
  return number_or_nan(find(*scene_, path));
}

Quantity FinishedRun::scalar(const std::string& name) const {
  Quantity quantity;
  Steadiness own = Steadiness::kUnknown;
  if (const Json* measured = find(*summary_, "measured"); measured != nullptr && measured->contains(name)) {
    const Json& scalar = measured->at(name);
    quantity = {number_or_nan(find(scalar, "value")), number_or_nan(find(scalar, "sem"))};
    own = steadiness_of(find(scalar, "steady"));
  } else {
    quantity.value = number_or_nan(find(*summary_, name));
    if (name == "order.mean") {
      quantity.sem = number_or_nan(find(*summary_, "order.sem"));
      own = steadiness_of(find(*summary_, "order.steady"));
    }
  }
  // What the run cannot tell of this number it may tell of itself, and the other way round.
  const Steadiness all = steadiness();
  quantity.steadiness = own == Steadiness::kUnknown ? all : all == Steadiness::kUnknown ? own : worse(own, all);
  return quantity;
}

Steadiness FinishedRun::steadiness() const { return steadiness_of(find(*summary_, "steady")); }

std::string FinishedRun::versions() const {
  std::string words;
  if (const Json* versions = find(*summary_, "versions"); versions != nullptr && versions->is_object()) {
    for (const auto& [name, version] : versions->items()) {
      words += (words.empty() ? "" : ", ") + name + " " +
               (version.is_string() ? version.get<std::string>() : version.dump());
    }
  }
  return words.empty() ? "an unknown version" : words;
}

std::string FinishedRun::finished() const {
  const Json* time = find(*summary_, "finished");
  return time != nullptr && time->is_string() ? time->get<std::string>() : "an unknown time";
}

const std::vector<double>& FinishedRun::array(const std::string& path) const {
  static const std::vector<double> kNone;
  if (!observables_) {
    auto read = run::read_observables(run::RunDirectory{directory_}.observables());
    if (!read) throw Failure(ExitCode::kFailed, read.error().message);
    observables_ = std::make_shared<const run::Observables>(*std::move(read));
  }
  const auto found = observables_->find(path);
  return found == observables_->end() ? kNone : found->second;
}

bool is_finished(const std::filesystem::path& directory) {
  const auto text = read_file(run::RunDirectory{directory}.summary());
  if (!text) return false;
  const Json summary = Json::parse(*text, nullptr, false);
  const Json* state = find(summary, "exit.state");
  return state != nullptr && *state == "done";
}

RunSet where(const RunSet& runs, const std::string& path, double value) {
  RunSet chosen;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(chosen),
               [&](const FinishedRun& run) { return same(run.number(path), value); });
  return chosen;
}

std::vector<double> values_of(const RunSet& runs, const std::string& path) {
  std::vector<double> values;
  for (const FinishedRun& run : runs) {
    const double value = run.number(path);
    if (std::isnan(value)) continue;
    if (std::none_of(values.begin(), values.end(), [&](double known) { return same(known, value); })) {
      values.push_back(value);
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

RunSet joined(const RunSet& a, const RunSet& b) {
  RunSet all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

RunSet with_extreme(const RunSet& runs, const std::string& path, bool largest) {
  const std::vector<double> values = values_of(runs, path);
  return values.empty() ? runs : where(runs, path, largest ? values.back() : values.front());
}

RunSet at_point_of(const RunSet& runs, const FinishedRun& point) {
  RunSet found = runs;
  for (const char* key : {"rods.length", "rods.end_diameter", "rods.area_fraction"}) {
    found = where(found, key, point.number(key));
  }
  return found;
}

RunSet layered(const RunSet& runs) {
  RunSet chosen;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(chosen),
               [](const FinishedRun& run) { return run.scalar("theta_m_deg").is_known(); });
  return chosen;
}

Quantity mean_of(std::span<const Quantity> replicas) {
  std::vector<double> values, errors;
  Steadiness steadiness = Steadiness::kSteady;
  for (const Quantity& quantity : replicas) {
    if (!quantity.is_known()) return {};
    values.push_back(quantity.value);
    errors.push_back(quantity.sem);
    steadiness = worse(steadiness, quantity.steadiness);
  }
  if (values.empty()) return {};
  const MeanAndError mean = replica_mean(values, errors);
  return {mean.mean, mean.sem.value_or(NAN), steadiness};
}

Quantity mean_scalar(const RunSet& replicas, const std::string& name) {
  std::vector<Quantity> values;
  for (const FinishedRun& run : replicas) values.push_back(run.scalar(name));
  return mean_of(values);
}

std::vector<Point> scalar_points(const RunSet& runs, const std::string& key, const std::string& scalar) {
  std::vector<Point> points;
  for (const double value : values_of(runs, key)) {
    points.push_back({value, mean_scalar(where(runs, key, value), scalar)});
  }
  return points;
}

Quantity crossing(std::vector<Point> points, double level) {
  std::erase_if(points, [](const Point& point) { return !point.quantity.is_known(); });
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.at < b.at; });
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const auto& [x0, low] = points[k];
    const auto& [x1, high] = points[k + 1];
    if (!(low.value < level) || !(high.value >= level)) continue;
    const double part = (level - low.value) / (high.value - low.value);
    const double slope = (high.value - low.value) / (x1 - x0);
    return {x0 + part * (x1 - x0), std::hypot((1 - part) * low.sem, part * high.sem) / slope,
            worse(low.steadiness, high.steadiness)};
  }
  return {};
}

const RunSet& Library::operator[](const std::string& name) const {
  static const RunSet kNone;
  const auto found = sets_.find(name);
  return found == sets_.end() ? kNone : found->second;
}

}  // namespace shaken::client
