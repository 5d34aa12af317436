#include "run/loop/summary.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "analysis/errors/parts.h"
#include "base/files.h"
#include "base/steadiness.h"
#include "run/files/version.h"

namespace shaken::run {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string host_name() {
  char name[256] = "";
  gethostname(name, sizeof(name) - 1);
  return name;
}

OrderedJson to_json(const EffectReport& effect) {
  OrderedJson json{{"on", effect.on}};
  for (const auto& [name, amount] : effect.work) {
    // Counts as whole numbers, whatever their size.
    const auto whole = static_cast<std::int64_t>(amount);
    json[name] = static_cast<double>(whole) == amount ? OrderedJson(whole) : OrderedJson(amount);
  }
  return json;
}

/// JSON has no NaN.
OrderedJson number_or_null(double value) { return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr); }

OrderedJson to_json(const Balance& balance) {
  return {{"start", balance.energy_start},
          {"given_by_plates", balance.energy_given_by_surfaces},
          {"given_by_noise", balance.energy_given_by_noise},
          {"lost_rod_rod", balance.energy_lost_rod_rod},
          {"lost_surfaces", balance.energy_lost_surfaces},
          {"left", balance.energy_now},
          {"unexplained", balance.energy_unexplained}};
}

OrderedJson drift_json(double value, double sem) {
  return {{"value", number_or_null(value)}, {"sem", number_or_null(sem)}};
}

/// What a measurement of recorded frames leaves open.
constexpr const char* kOfSimulations[] = {
    "/rod_seconds_per_cpu_second",   "/collisions", "/max_overlap_mm",  "/energy_pJ",
    "/momentum_unexplained_mg_mm_s", "/state_hash", "/versions/physics"};

/// Null where rods were placed.
OrderedJson json_of(const std::optional<scene::StartState>& start) {
  return start ? OrderedJson{{"run", start->run}, {"time_s", start->time}} : OrderedJson(nullptr);
}

/// Null where it is not known.
OrderedJson json_of(std::optional<bool> known) { return known ? OrderedJson(*known) : OrderedJson(nullptr); }

/// Why the value at `path` ("measured.dip.sem") is null, as far as the path tells.
std::string why_null(const std::string& path, const Summary& summary) {
  const auto ends = [&](std::string_view end) { return path.ends_with(end); };
  std::string pointer = "/" + path;
  std::ranges::replace(pointer, '.', '/');
  if (summary.frames && std::ranges::find(kOfSimulations, pointer) != std::end(kOfSimulations))
    return "measured on recorded frames, not simulated";
  if (path == "start") return "the rods were placed, not taken over from another run";
  if (!summary.has_axis && (path == "order" || path == "defects")) return "spheres have no axis";
  if (!summary.has_axis && path == "steady") return "S would tell, and spheres have none";
  if (path == "order") return "the scene does not measure S (measure.order)";
  if (path == "defects") return "the scene does not measure them (measure.defects)";
  if (path == "steady" && !summary.order) return "S, which would tell, is not measured (measure.order)";
  if (path.starts_with("measured.") && ends(".value")) {
    constexpr std::size_t kBefore = std::string_view("measured.").size();
    const std::string name = path.substr(kBefore, path.size() - kBefore - std::string_view(".value").size());
    const auto scalar = summary.scalars.find(name);
    if (scalar != summary.scalars.end() && !scalar->second.reason.empty() && !path.ends_with("drift.value"))
      return scalar->second.reason;
  }
  if (ends("steady")) return "no average over time, or of too few independent samples to tell";
  if (ends("sem") || ends("drift.value") || ends("n_effective") || ends("sem_if_steady"))
    return "no average over time, or of too few independent samples";
  return "a sum became too large, or was no number";
}

/// The path of every null in `json`, with its reason.
void explain_nulls(const OrderedJson& json, const std::string& path, const Summary& summary, OrderedJson& reasons) {
  if (json.is_null()) reasons[path] = why_null(path, summary);
  if (!json.is_structured()) return;
  for (const auto& [key, value] : json.items())
    explain_nulls(value, path.empty() ? key : fmt::format("{}.{}", path, key), summary, reasons);
}

}  // namespace

double shown_error(double sem, std::optional<bool> steady, double drift, double drift_sem) {
  return steady == true ? sem : std::hypot(sem, drift, drift_sem);
}

double shown_error(const analysis::SteadySummary& order) {
  return shown_error(order.sem, order.steady, order.drift.value, order.drift.sem);
}

std::string why_not_steady(const analysis::SteadySummary& order, double sim_seconds) {
  const Steadiness steadiness = steadiness_of(order.steady);
  if (steadiness == Steadiness::kSteady) return "";
  std::string why;
  if (steadiness == Steadiness::kNotKnown) {
    why = fmt::format("the average of S is worth about {:.0f} independent samples", order.n_effective);
  } else if (std::abs(order.drift.value) > analysis::kDriftErrors * order.drift.sem) {
    why = fmt::format("S changes by {:.2g} +- {:.1g} from the first half of its average to the second",
                      order.drift.value, order.drift.sem);
  } else {
    why =
        fmt::format("S was on its way until {:.4g} s of {:.4g} s, beyond half of the run", order.t_steady, sim_seconds);
  }
  return fmt::format("{}: {}; measure longer", word_of(steadiness), why);
}

void fill(Summary& summary, const scene::RunPlan& plan, const Reduction& reduction) {
  summary.t_steady = reduction.t_steady;
  summary.order = reduction.order;
  summary.has_axis = plan.system.rod.has_axis();
  summary.scalars = reduction.scalars;
  if (!reduction.defects) return;
  summary.defects_mean_plus = reduction.defects->n_plus;
  summary.defects_mean_minus = reduction.defects->n_minus;
}

std::string summary_text(const Summary& summary) {
  OrderedJson json{
      {"run_id", summary.run_id},
      {"start", json_of(summary.start)},
      {"n_rods", summary.n_rods},
      {"sim_seconds", summary.sim_seconds},
      {"cpu_seconds", summary.cpu_seconds},
      {"wall_seconds", summary.wall_seconds},
      {"rod_seconds_per_cpu_second",
       summary.cpu_seconds > 0 ? summary.n_rods * summary.sim_seconds / summary.cpu_seconds : 0.0},
      {"collisions",
       {{"rod_rod", summary.collisions_rod_rod},
        {"rod_base", summary.collisions_rod_base},
        {"rod_lid", summary.collisions_rod_lid},
        {"rod_wall", summary.collisions_rod_wall},
        {"rod_post", summary.collisions_rod_post}}},
      {"max_overlap_mm", summary.max_overlap},
      {"energy_pJ", to_json(summary.balance)},
      {"momentum_unexplained_mg_mm_s",
       {summary.balance.momentum_unexplained.x(), summary.balance.momentum_unexplained.y(),
        summary.balance.momentum_unexplained.z()}},
      {"t_steady_s", summary.t_steady},
      {"steady", summary.order ? json_of(summary.order->steady) : OrderedJson(nullptr)},
      {"order", nullptr},
      {"defects", nullptr},
  };
  if (summary.order) {
    json["order"] = {{"mean", summary.order->mean},
                     {"std", summary.order->std},
                     {"sem", number_or_null(shown_error(*summary.order))},
                     {"tau_s", summary.order->tau},
                     {"t_steady_s", summary.order->t_steady},
                     {"n_effective", summary.order->n_effective},
                     {"steady", json_of(summary.order->steady)},
                     {"drift", drift_json(summary.order->drift.value, summary.order->drift.sem)}};
    if (summary.order->steady != true) json["order"]["sem_if_steady"] = number_or_null(summary.order->sem);
    if (const std::string why = why_not_steady(*summary.order, summary.sim_seconds); !why.empty())
      json["order"]["why_not_steady"] = why;
  }
  if (summary.defects_mean_plus && summary.defects_mean_minus) {
    json["defects"] = {{"mean_plus", *summary.defects_mean_plus}, {"mean_minus", *summary.defects_mean_minus}};
  }
  json["measured"] = OrderedJson::object();
  for (const auto& [name, scalar] : summary.scalars) {
    // what has no drift is no average over time
    const double sem = std::isfinite(scalar.drift)
                           ? shown_error(scalar.sem, scalar.steady, scalar.drift, scalar.drift_sem)
                           : scalar.sem;
    json["measured"][name] = {{"value", number_or_null(scalar.value)},
                              {"sem", number_or_null(sem)},
                              {"n_effective", number_or_null(scalar.n_effective)},
                              {"steady", json_of(scalar.steady)},
                              {"drift", drift_json(scalar.drift, scalar.drift_sem)}};
    if (std::isfinite(sem) && sem != scalar.sem) json["measured"][name]["sem_if_steady"] = scalar.sem;
    if (std::isfinite(scalar.over)) json["measured"][name]["over_s"] = scalar.over;
    if (!scalar.reason.empty()) json["measured"][name]["reason"] = scalar.reason;
  }
  for (const auto& [name, effect] : summary.effects) json["effects"][name] = to_json(effect);
  json["why_null"] = OrderedJson::object();  // once all is known
  json["state_hash"] = fmt::format("{:016x}", summary.state_hash);
  json["files"] = OrderedJson::object();
  for (const auto& [name, hash] : summary.files) {
    json["files"][name] = {{"bytes", hash.size}, {"xxh3", fmt::format("{:016x}", hash.xxh3)}};
  }
  json["exit"] = {{"state", summary.state}, {"reason", summary.reason}, {"tick", summary.tick}, {"rods", summary.rods}};
  if (summary.done_before) json["exit"]["done_before_s"] = *summary.done_before;
  json["versions"] = {{"shaken", version()}, {"physics", summary.physics}, {"compiler", compiler()}};
  json["host"] = host_name();
  json["started"] = summary.started;
  json["finished"] = summary.finished;
  if (const auto& frames = summary.frames) {
    json["frames"] = {{"file", frames->file},
                      {"n", frames->n},
                      {"first_s", frames->first},
                      {"last_s", frames->last},
                      {"remarks", frames->remarks}};
    for (const char* name : kOfSimulations) json[OrderedJson::json_pointer(name)] = nullptr;
  }
  OrderedJson reasons = OrderedJson::object();
  explain_nulls(json, "", summary, reasons);
  json["why_null"] = std::move(reasons);
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

Result<void> write_summary(const std::filesystem::path& file, const Summary& summary) {
  return write_file_atomically(file, summary_text(summary));
}

}  // namespace shaken::run
