// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "client/json.h"
#include "run/files/observables_file.h"

namespace shaken::study {

using client::Json;

/// The keys of the scene by which runs are told apart most often.
inline constexpr const char* kPacking = "rods.area_fraction";
inline constexpr const char* kLength = "rods.length";

/// A change of S by less than this leaves the other averages of its run what they are.
inline constexpr double kSmallDriftOfOrder = 0.05;

/// A number that was not measured but given: exact, and the same for ever.
Estimate exactly(double value);
/// The standard error that a number is judged with: its own where it is steady. Where that cannot be told its drift,
/// and the error of the drift, are added in quadrature: a mean that still relaxes, over no more than half of the time
/// that it was taken from, is off by about what its halves differ, or less. NaN if any of these is unknown.
double judged_error(const Estimate& estimate);

/// A number that `estimate` goes into, with the derivative of that number by it.
struct Term {
  double slope = 0;
  Estimate estimate{};
};
/// A number made of independent others, to first order: as steady as all of them, with their errors and drifts.
Estimate derived(double value, std::span<const Term> terms);

/// A run that is done, as its directory tells it. Files are read once, when they are first asked for.
class FinishedRun {
 public:
  /// `parameters` are the swept ones, {path: value} as they were asked for: an area fraction of 0.75 is 0.7486 in the
  /// resolved scene, by whole rods. Throws Failure if the directory holds no scene and no summary.
  explicit FinishedRun(std::filesystem::path directory, Json parameters = Json::object());
  /// The same, of contents that need no directory.
  FinishedRun(Json scene, Json summary, run::Observables observables, Json parameters = Json::object());

  const std::filesystem::path& directory() const { return directory_; }
  /// Its run's, by which equal runs are told; empty if the summary does not say.
  std::string id() const;
  /// A key of the scene, "rods.length", in its default unit: as it was asked for if it was swept, else as resolved. NaN
  /// if it is not there or no number.
  double number(const std::string& path) const;
  /// A number of summary.json: "order.mean" (with its error), "cpu_seconds", or one of "measured". It is steady if the
  /// run is, or says so of this number, and neither says that it still relaxes.
  Estimate scalar(const std::string& name) const;
  /// Of the whole run: "steady" of summary.json; where that is left open, true if S is known to drift by less than
  /// kSmallDriftOfOrder. None: that is not known either, or nobody tested it (no S(t), an older version).
  std::optional<bool> steady() const;
  /// A number that was worked out from this run's arrays, as steady as the run.
  Estimate estimate(double value, double sem) const { return {.value = value, .sem = sem, .steady = steady()}; }
  /// What made it, as summary.json tells: "shaken 0.2.0, compiler g++ 12.2"; and when it was finished.
  std::string versions() const;
  std::string finished() const;
  /// An array of observables.h5; empty if it is not there.
  const std::vector<double>& array(const std::string& path) const;

 private:
  std::filesystem::path directory_;
  Json parameters_;
  std::shared_ptr<const Json> scene_, summary_;
  mutable std::shared_ptr<const run::Observables> observables_;
};

using RunSet = std::vector<FinishedRun>;

/// The runs whose scene has `value` at `path`, up to rounding.
RunSet where(const RunSet& runs, const std::string& path, double value);
/// The values that the runs have at `path`, rising, each once.
std::vector<double> values_of(const RunSet& runs, const std::string& path);

/// Both together, each run once.
RunSet joined(const RunSet& a, const RunSet& b);
/// The runs with the largest (or smallest) value at `path`; all of them if none has any.
RunSet with_extreme(const RunSet& runs, const std::string& path, bool largest);

/// The runs of the same rods at the same packing as `point`.
RunSet at_point_of(const RunSet& runs, const FinishedRun& point);

/// The runs whose P(theta) has two peaks. Others may have a wavelength too, that of the director's slow bend.
RunSet layered(const RunSet& runs);

/// Mean over replicas; unknown unless every one of them knows it, steady if every one of them is. Its error is that of
/// client::replica_mean().
Estimate mean_of(std::span<const Estimate> replicas);
/// That of what `of` finds in each of the runs.
Estimate mean_over(const RunSet& replicas, const std::function<Estimate(const FinishedRun&)>& of);
Estimate mean_scalar(const RunSet& replicas, const std::string& name);

/// A number at a value of a key of the scene.
struct Point {
  double at = 0;
  Estimate estimate{};
};
/// A scalar at each value of a key, rising, averaged over replicas; unknown where they do not know it.
std::vector<Point> scalar_points(const RunSet& runs, const std::string& key, const std::string& scalar);
/// Where a quantity rises through `level`, interpolated linearly between neighbouring points, with the error that
/// theirs give. Unknown if it does not. Points need not be in order.
Estimate crossing(std::vector<Point> points, double level);

/// The finished runs of each sweep, by the sweep's name; one that has none is an empty set.
class Library {
 public:
  void add(const std::string& name, RunSet runs) { sets_[name] = std::move(runs); }
  const RunSet& operator[](const std::string& name) const;

 private:
  std::map<std::string, RunSet> sets_;
};

}  // namespace shaken::study
