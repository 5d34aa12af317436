#include "run/loop/summary.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/errors/parts.h"
#include "base/files.h"
#include "base/steadiness.h"
#include "base/text.h"
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

/// Null where rods were placed.
OrderedJson json_of(const std::optional<scene::StartState>& start) {
  return start ? OrderedJson{{"run", start->run}, {"time_s", start->time}} : OrderedJson(nullptr);
}

/// Null where it is not known.
OrderedJson json_of(std::optional<bool> known) { return known ? OrderedJson(*known) : OrderedJson(nullptr); }

OrderedJson order_json(const Summary& summary) {
  if (!summary.order) return nullptr;
  const analysis::SteadySummary& order = *summary.order;
  OrderedJson json{{"mean", order.mean},
                   {"std", order.std},
                   {"sem", number_or_null(shown_error(order))},
                   {"tau_s", order.tau},
                   {"t_steady_s", order.t_steady},
                   {"n_effective", order.n_effective},
                   {"steady", json_of(order.steady)},
                   {"drift", drift_json(order.drift.value, order.drift.sem)}};
  if (order.steady != true) json["sem_if_steady"] = number_or_null(order.sem);
  if (const std::string why = why_not_steady(order, summary.sim_seconds); !why.empty()) json["why_not_steady"] = why;
  return json;
}

OrderedJson defects_json(const Summary& summary) {
  if (!summary.defects_mean_plus || !summary.defects_mean_minus) return nullptr;
  return {{"mean_plus", *summary.defects_mean_plus}, {"mean_minus", *summary.defects_mean_minus}};
}

template <auto Member>
OrderedJson at(const Summary& summary) {
  return summary.*Member;
}

constexpr std::string_view kNotSimulated = "measured on recorded frames, not simulated";
using Of = const Summary&;

// clang-format off
constexpr auto kKeys = std::to_array<SummaryKey>({
    {"start", "", "", "`run` and `time_s`: the state that the run began with "
     "([starts.md](starts.md#from-the-end-of-another-run))", [](Of s) { return json_of(s.start); },
     "the rods were placed, not taken over from another run"},
    {"n_rods", "1", "", "number of rods, of all species", at<&Summary::n_rods>},
    {"sim_seconds", "s", "simulated time", "simulated time", at<&Summary::sim_seconds>},
    {"cpu_seconds", "s", "CPU time", "CPU time of this worker and those before it", at<&Summary::cpu_seconds>},
    {"wall_seconds", "s", "wall time", "wall time of these", at<&Summary::wall_seconds>},
    {"rod_seconds_per_cpu_second", "1", "", "rods times simulated seconds, per second of CPU time",
     [](Of s) -> OrderedJson { return s.cpu_seconds > 0 ? s.n_rods * s.sim_seconds / s.cpu_seconds : 0.0; },
     kNotSimulated},
    {"collisions", "1", "", "impulses given: `rod_rod`, `rod_base`, `rod_lid`, `rod_wall`, `rod_post`",
     [](Of s) -> OrderedJson { return {{"rod_rod", s.collisions_rod_rod}, {"rod_base", s.collisions_rod_base},
                                       {"rod_lid", s.collisions_rod_lid}, {"rod_wall", s.collisions_rod_wall},
                                       {"rod_post", s.collisions_rod_post}}; }, kNotSimulated},
    {"max_overlap_mm", "mm", "deepest overlap", "deepest overlap found at a contact", at<&Summary::max_overlap>,
     kNotSimulated},
    {"energy_pJ", "pJ", "", "the energy balance, see below", [](Of s) { return to_json(s.balance); }, kNotSimulated},
    {"momentum_unexplained_mg_mm_s", "mg mm s-1", "", "the unexplained part of the momentum balance: x, y, z",
     [](Of s) -> OrderedJson { const Vec3& p = s.balance.momentum_unexplained; return {p.x(), p.y(), p.z()}; },
     kNotSimulated},
    {"t_steady_s", "s", "", "where the averages begin", at<&Summary::t_steady>},
    {"steady", "", "", "whether the averages are of a steady state, see below",
     [](Of s) { return s.order ? json_of(s.order->steady) : OrderedJson(nullptr); },
     "S, which would tell, is not measured (measure.order)", "S would tell, and spheres have none"},
    {"order", "", "", "the average of S(t), see below", order_json,
     "the scene does not measure S (measure.order)", "spheres have no axis", "mean std"},
    {"defects", "1", "", "`mean_plus` and `mean_minus`: mean numbers of ±1/2 defects", defects_json,
     "the scene does not measure them (measure.defects)", "spheres have no axis", "mean_plus mean_minus"},
});
// clang-format on

/// Why the value at `path` ("measured.dip.sem") is null, as far as the path tells.
std::string_view why_null(const std::string& path, const Summary& summary) {
  const auto ends = [&](std::string_view end) { return path.ends_with(end); };
  if (path == "state_hash" || path == "versions.physics") return kNotSimulated;
  const auto key = std::ranges::find(kKeys, path, &SummaryKey::name);
  if (key != kKeys.end() && !key->if_null.empty() && !(path == "steady" && summary.order))
    return summary.has_axis || key->of_spheres.empty() ? key->if_null : key->of_spheres;
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

/// The path of every null in `json`, as which numbers that are none are written too, with its reason.
void explain_nulls(const OrderedJson& json, const std::string& path, const Summary& summary, OrderedJson& reasons) {
  if (json.is_null() || (json.is_number() && json.dump() == "null")) reasons[path] = why_null(path, summary);
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
    why = fmt::format("S changes by {} from the first half of its average to the second",
                      with_error(order.drift.value, order.drift.sem));
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

std::span<const SummaryKey> summary_keys() { return kKeys; }

std::string summary_text(const Summary& summary) {
  OrderedJson json{{"run_id", summary.run_id}};
  for (const SummaryKey& key : kKeys) {
    const bool is_open = summary.frames && key.if_null == kNotSimulated;
    json[std::string(key.name)] = is_open ? OrderedJson(nullptr) : key.value(summary);
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
    json["state_hash"] = json["versions"]["physics"] = nullptr;
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
