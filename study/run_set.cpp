// SPDX-License-Identifier: MIT
#include "study/run_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/failure.h"
#include "base/files.h"
#include "client/replicas.h"
#include "run/files/directory.h"

namespace shaken::study {
namespace {

std::shared_ptr<const Json> read_json(const std::filesystem::path& file) {
  Json json = Json::parse(value_or_fail(read_file(file)), nullptr, false);
  if (!json.is_object()) throw Failure(ExitCode::kFailed, file.string() + " is no JSON object");
  return std::make_shared<const Json>(std::move(json));
}

/// Errors that a small drift of S must have to spare: as many as make one larger than them a drift at all.
constexpr double kDriftErrors = 2.6;

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

/// A flag; none if it is null or absent.
std::optional<bool> flag_of(const Json* json) {
  return json != nullptr && json->is_boolean() ? std::optional(json->get<bool>()) : std::nullopt;
}

/// False if one is not, unknown if one is unknown.
std::optional<bool> both_steady(std::optional<bool> a, std::optional<bool> b) {
  if (a == false || b == false) return false;
  return a && b ? std::optional(true) : std::nullopt;
}

/// Of an object at `path` with value and sem; unknown if it is not there.
void read_drift(Estimate& estimate, const Json& json, const std::string& path) {
  estimate.drift = number_or_nan(find(json, path + ".value"));
  estimate.drift_sem = number_or_nan(find(json, path + ".sem"));
}

bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)}); }

}  // namespace

namespace {

/// Without the drift that `sem` holds where a mean is not known to be steady; judged_error() adds that.
double own_error(const Json& estimate) {
  return number_or_nan(find(estimate, estimate.contains("sem_if_steady") ? "sem_if_steady" : "sem"));
}

}  // namespace

double judged_error(const Estimate& estimate) {
  if (estimate.steady == true) return estimate.sem;
  return std::hypot(estimate.sem, estimate.drift, estimate.drift_sem);
}

Estimate derived(double value, std::span<const Term> terms) {
  Estimate result{.value = value, .sem = 0, .steady = true, .drift = 0, .drift_sem = 0};
  for (const auto& [slope, estimate] : terms) {
    result.sem = std::hypot(result.sem, slope * estimate.sem);
    result.steady = both_steady(result.steady, estimate.steady);
    if (estimate.steady == true) continue;  // what is steady drifts by chance alone
    result.drift += slope * estimate.drift;
    result.drift_sem = std::hypot(result.drift_sem, slope * estimate.drift_sem);
  }
  return result;
}

Estimate exactly(double value) { return {.value = value, .sem = 0, .steady = true}; }

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

std::string FinishedRun::id() const {
  const Json* id = find(*summary_, "run_id");
  return id != nullptr && id->is_string() ? id->get<std::string>() : "";
}

double FinishedRun::number(const std::string& path) const {
  if (parameters_.contains(path)) return number_or_nan(&parameters_.at(path));
  return number_or_nan(find(*scene_, path));
}

Estimate FinishedRun::scalar(const std::string& name) const {
  Estimate estimate;
  if (const Json* measured = find(*summary_, "measured"); measured != nullptr && measured->contains(name)) {
    const Json& scalar = measured->at(name);
    estimate.value = number_or_nan(find(scalar, "value"));
    estimate.sem = own_error(scalar);
    estimate.steady = flag_of(find(scalar, "steady"));
    read_drift(estimate, scalar, "drift");
  } else {
    estimate.value = number_or_nan(find(*summary_, name));
    if (name == "order.mean") {
      if (const Json* order = find(*summary_, "order")) estimate.sem = own_error(*order);
      estimate.steady = flag_of(find(*summary_, "order.steady"));
      read_drift(estimate, *summary_, "order.drift");
    }
  }
  // What the run cannot tell of this number it may tell of itself, and the other way round. A number that knows its own
  // drift is judged by that rather than by how little S drifts.
  const std::optional<bool> own = estimate.steady, all = flag_of(find(*summary_, "steady"));
  if (own == false || all == false) {
    estimate.steady = false;
  } else if (own || all) {
    estimate.steady = true;
  } else if (!std::isfinite(estimate.drift_sem)) {
    estimate.steady = steady();
  }
  return estimate;
}

std::optional<bool> FinishedRun::steady() const {
  if (const std::optional<bool> told = flag_of(find(*summary_, "steady"))) return told;
  Estimate order;
  read_drift(order, *summary_, "order.drift");
  const bool hardly_drifts = std::abs(order.drift) + kDriftErrors * order.drift_sem < kSmallDriftOfOrder;
  return hardly_drifts ? std::optional(true) : std::nullopt;
}

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
    observables_ = std::make_shared<const run::Observables>(
        value_or_fail(run::read_observables(run::RunDirectory{directory_}.observables())));
  }
  const auto found = observables_->find(path);
  return found == observables_->end() ? kNone : found->second;
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
  std::set<std::string> ids;
  for (const FinishedRun& run : a) ids.insert(run.id());
  for (const FinishedRun& run : b) {
    if (run.id().empty() || ids.insert(run.id()).second) all.push_back(run);
  }
  return all;
}

RunSet with_extreme(const RunSet& runs, const std::string& path, bool largest) {
  const std::vector<double> values = values_of(runs, path);
  return values.empty() ? runs : where(runs, path, largest ? values.back() : values.front());
}

RunSet at_point_of(const RunSet& runs, const FinishedRun& point) {
  RunSet found = runs;
  for (const char* key : {kLength, "rods.end_diameter", kPacking}) {
    found = where(found, key, point.number(key));
  }
  return found;
}

RunSet layered(const RunSet& runs) {
  RunSet chosen;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(chosen),
               [](const FinishedRun& run) { return is_known(run.scalar("theta_m_deg")); });
  return chosen;
}

Estimate mean_of(std::span<const Estimate> replicas) {
  std::vector<double> values, errors;
  std::vector<Term> terms;
  for (const Estimate& replica : replicas) {
    if (!is_known(replica)) return {};
    values.push_back(replica.value);
    errors.push_back(replica.sem);
    terms.push_back({1 / static_cast<double>(replicas.size()), replica});
  }
  if (values.empty()) return {};
  const Estimate mean = client::replica_mean(values, errors);
  Estimate result = derived(mean.value, terms);
  result.sem = mean.sem;
  return result;
}

Estimate mean_over(const RunSet& replicas, const std::function<Estimate(const FinishedRun&)>& of) {
  std::vector<Estimate> estimates;
  for (const FinishedRun& run : replicas) estimates.push_back(of(run));
  return mean_of(estimates);
}

Estimate mean_scalar(const RunSet& replicas, const std::string& name) {
  return mean_over(replicas, [&](const FinishedRun& run) { return run.scalar(name); });
}

std::vector<Point> scalar_points(const RunSet& runs, const std::string& key, const std::string& scalar) {
  std::vector<Point> points;
  for (const double value : values_of(runs, key)) {
    points.push_back({value, mean_scalar(where(runs, key, value), scalar)});
  }
  return points;
}

Estimate crossing(std::vector<Point> points, double level) {
  std::erase_if(points, [](const Point& point) { return !is_known(point.estimate); });
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.at < b.at; });
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const auto& [x0, low] = points[k];
    const auto& [x1, high] = points[k + 1];
    if (!(low.value < level) || !(high.value >= level)) continue;
    const double part = (level - low.value) / (high.value - low.value);
    const double slope = (high.value - low.value) / (x1 - x0);
    return derived(x0 + part * (x1 - x0), std::vector<Term>{{-(1 - part) / slope, low}, {-part / slope, high}});
  }
  return {};
}

const RunSet& Library::operator[](const std::string& name) const {
  static const RunSet kNone;
  const auto found = sets_.find(name);
  return found == sets_.end() ? kNone : found->second;
}

}  // namespace shaken::study
