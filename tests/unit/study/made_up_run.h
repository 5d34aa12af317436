// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "study/run_set.h"

namespace shaken::study {

/// A finished run with the numbers that a test wants: of rods of a length [mm] at an area fraction, steady, in the
/// paper's box and gap, unless it is said otherwise. An error of NaN is written as null, as a worker writes it.
class MadeUp {
 public:
  MadeUp(double length, double fraction)
      : scene_{{"rods", {{"length", length}, {"area_fraction", 0.998 * fraction}, {"end_diameter", 0.4}}},
               {"box", {{"side", 83.73}, {"gap", 1.2}}}},
        summary_{{"n_rods", 400},
                 {"sim_seconds", 700},
                 {"t_steady_s", 100},
                 {"steady", true},
                 {"measured", Json::object()},
                 {"order", {{"n_effective", 200}}},
                 {"exit", {{"state", "done"}}}},
        parameters_{{"rods.area_fraction", fraction}} {}

  MadeUp& box(double side) { return key("box", "side", side); }
  MadeUp& gap(double gap) { return key("box", "gap", gap); }
  MadeUp& end(double diameter) { return key("rods", "end_diameter", diameter); }
  MadeUp& gamma(double gamma) { return key("plates", "gamma", gamma); }
  MadeUp& seed(int seed) { return key("time", "seed", seed); }
  MadeUp& key(const std::string& block, const std::string& name, const Json& value) {
    scene_[block][name] = value;
    return *this;
  }

  MadeUp& order(double mean, double sem = 0.01) {
    summary_["order"]["mean"] = mean;
    summary_["order"]["sem"] = number_or_null(sem);
    return *this;
  }
  /// A number of summary.json beside "measured".
  MadeUp& number(const Json::json_pointer& path, const Json& value) {
    summary_[path] = value;
    return *this;
  }
  MadeUp& scalar(const std::string& name, double value, double sem) {
    summary_["measured"][name] = {{"value", number_or_null(value)}, {"sem", number_or_null(sem)}, {"steady", nullptr}};
    return *this;
  }
  /// A scalar that cannot have an error.
  MadeUp& scalar(const std::string& name, double value) { return scalar(name, value, NAN); }
  MadeUp& array(const std::string& path, std::vector<double> values) {
    arrays_[path] = std::move(values);
    return *this;
  }
  /// A curve that is the same everywhere, with errors.
  MadeUp& level(const std::string& path, double value, double sem) {
    return array(path, std::vector<double>(8, value)).array(path + "_sem", std::vector<double>(8, sem));
  }

  MadeUp& relaxing() { return number(Json::json_pointer("/steady"), false); }
  /// As a version that did not test it left it.
  MadeUp& untested() {
    summary_.erase("steady");
    return *this;
  }
  MadeUp& without_errors() {
    for (Json& scalar : summary_["measured"]) scalar["sem"] = nullptr;
    summary_["order"]["sem"] = nullptr;
    summary_["order"]["n_effective"] = nullptr;
    for (auto& [path, values] : arrays_) {
      if (path.find("_sem") != std::string::npos) values.assign(values.size(), NAN);
    }
    return *this;
  }

  FinishedRun run() const { return {scene_, summary_, arrays_, parameters_}; }

 private:
  static Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

  Json scene_, summary_;
  run::Observables arrays_;
  Json parameters_;
};

/// Runs by sweep.
using MadeUpSets = std::vector<std::pair<std::string, std::vector<MadeUp>>>;

inline Library library_of(const MadeUpSets& sets) {
  Library library;
  for (const auto& [name, runs] : sets) {
    RunSet set;
    for (const MadeUp& made_up : runs) set.push_back(made_up.run());
    library.add(name, set);
  }
  return library;
}

}  // namespace shaken::study
