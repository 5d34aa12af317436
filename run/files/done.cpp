#include "run/files/done.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/files.h"
#include "scene/canonical.h"
#include "scene/length.h"

namespace shaken::run {

namespace {

using Json = nlohmann::json;

/// The summary of a run, with an object "exit"; null otherwise. `run_id`: any if empty.
Json summary_of(const RunDirectory& directory, const std::string& run_id) {
  const Result<std::string> text = read_file(directory.summary());
  if (!text) return {};
  Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("exit") || !json["exit"].is_object()) return {};
  if (!run_id.empty() && (!json.contains("run_id") || json["run_id"] != run_id)) return {};
  return json;
}

bool says_done(const Json& summary) {
  return !summary.is_null() && summary["exit"].contains("state") && summary["exit"]["state"] == "done";
}

/// The same if it has come to its end; null otherwise.
Json summary_of_done(const RunDirectory& directory, const std::string& run_id) {
  Json summary = summary_of(directory, run_id);
  return says_done(summary) ? std::move(summary) : Json();
}

/// Whether the files of results are there that the summary names; those of older versions name none.
bool has_results(const RunDirectory& directory, const Json& summary) {
  const auto files = summary.find("files");
  if (files == summary.end() || !files->is_object()) return true;
  return std::all_of(files->items().begin(), files->items().end(), [&](const auto& file) {
    const Result<bool> is_there = file_exists(directory.root / file.key());
    return !is_there || *is_there;  // what cannot be looked at now is not gone
  });
}

/// None if the summary says nothing of S.
std::optional<scene::KnownOrder> order_of(const Json& summary) {
  const auto order = summary.find("order");
  if (order == summary.end() || !order->is_object()) return std::nullopt;
  scene::KnownOrder known{std::nan(""), std::nullopt};
  if (const auto sem = order->find("sem"); sem != order->end() && sem->is_number()) known.sem = sem->get<double>();
  if (const auto steady = order->find("steady"); steady != order->end() && steady->is_boolean()) {
    known.steady = steady->get<bool>();
  }
  return known;
}

std::optional<Tick> tick_of(const Json& summary) {
  if (summary.is_null()) return std::nullopt;
  const auto tick = summary["exit"].find("tick");
  if (tick == summary["exit"].end() || !tick->is_number_integer()) return std::nullopt;
  return tick->get<Tick>();
}

}  // namespace

std::optional<Tick> done_tick(const RunDirectory& directory, const std::string& run_id) {
  return tick_of(summary_of_done(directory, run_id));
}

std::optional<double> former_end(const RunDirectory& directory, const std::string& run_id) {
  const Json summary = summary_of(directory, run_id);
  if (summary.is_null()) return std::nullopt;
  const Json& from = says_done(summary) ? summary : summary["exit"];
  const auto time = from.find(says_done(summary) ? "sim_seconds" : "done_before_s");
  if (time == from.end() || !time->is_number()) return std::nullopt;
  return time->get<double>();
}

bool is_of_frames(const RunDirectory& directory) { return summary_of(directory, "").contains("frames"); }

bool is_done(const RunDirectory& directory, const std::string& run_id) {
  return !summary_of_done(directory, run_id).is_null();
}

bool is_done(const RunDirectory& directory, const scene::RunPlan& plan) {
  const Json summary = summary_of_done(directory, "");
  if (summary.is_null() || !summary.contains("run_id") || summary["run_id"] != scene::run_id(plan)) return false;
  const std::optional<Tick> tick = tick_of(summary);
  return tick && scene::is_long_enough(plan, *tick, order_of(summary)) && has_results(directory, summary);
}

}  // namespace shaken::run
