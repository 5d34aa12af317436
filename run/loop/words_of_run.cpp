#include "run/loop/words_of_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/steadiness.h"
#include "base/text.h"
#include "run/files/directory.h"
#include "run/files/observables_file.h"
#include "scene/keys/observables.h"

namespace shaken::run {
namespace {

using Json = nlohmann::json;

constexpr int kBarWidth = 24;

/// The number at object[key]; NaN if there is none.
double number(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_number() ? found->get<double>() : std::nan("");
}

std::string order_text(const Json& summary) {
  if (!summary.contains("order") || !summary["order"].is_object()) return "S was not measured\n";
  const Json& order = summary["order"];
  std::string text = fmt::format("S = {}", with_error(number(order, "mean"), number(order, "sem")));
  const double n_effective = number(order, "n_effective");
  text += fmt::format(", from {:.3g} s on", number(order, "t_steady_s"));
  if (n_effective > 0) text += fmt::format(", {:.3g} independent samples", n_effective);
  const Json known = summary.value("steady", Json());
  const Steadiness steadiness = steadiness_of(known.is_boolean() ? std::optional(known.get<bool>()) : std::nullopt);
  if (steadiness == Steadiness::kSteady) return text + ": steady\n";
  const std::string why = order.value("why_not_steady", "");
  text += fmt::format("\n{} {}", mark_of(steadiness), why.empty() ? word_of(steadiness) : why);
  const auto drift = order.find("drift");
  if (number(order, "sem") > 0 && drift != order.end() && std::isfinite(number(*drift, "value"))) {
    text += fmt::format("\n(the error holds the change of S from the first half of that time to the second, {})",
                        with_error(number(*drift, "value"), number(*drift, "sem")));
  }
  return text + fmt::format("\nRun longer, for example -s time.measure={:.3g}\n", 4 * number(summary, "sim_seconds"));
}

/// "curves of order, msd": the observables in the file.
std::string curves_of(const std::filesystem::path& file) {
  const Result<Observables> arrays = read_observables(file);
  std::string names;
  for (const scene::Observable& one : scene::observables()) {
    const auto is_of = [&](const auto& array) { return array.first.starts_with("/" + one.name + "/"); };
    if (arrays && std::ranges::any_of(*arrays, is_of)) names += (names.empty() ? " of " : ", ") + one.name;
  }
  return "curves" + names;
}

}  // namespace

std::string describe_progress(const Progress& progress) {
  const double fraction = std::clamp(progress.fraction(), 0.0, 1.0);
  std::string text = fmt::format("{} {:5.1f} %  {:.4g} of {:.4g} s", bar_text(fraction, kBarWidth), 100 * fraction,
                                 progress.sim_time, progress.sim_time_total);
  if (progress.state == "running") {
    text += fmt::format("  {:.3g} s/s  ETA {}", progress.sim_rate, duration_text(progress.eta));
  } else if (progress.state == "rendering") {
    text += fmt::format("  drawing {:.0f} %  ETA {}", 100 * progress.drawn, duration_text(progress.eta));
  } else {
    text += "  " + progress.state;
  }
  return std::isnan(progress.order) ? text : text + fmt::format("  S {:.3f}", progress.order);
}

bool is_under_way(const Progress& progress) { return progress.state == "running" || progress.state == "rendering"; }

std::string describe_ending(const Json& summary, const std::filesystem::path& directory) {
  const RunDirectory files{directory};
  std::string text =
      fmt::format("{} rods, {:.4g} s, in {} of CPU time\n{}", static_cast<long>(number(summary, "n_rods")),
                  number(summary, "sim_seconds"), duration_text(number(summary, "cpu_seconds")), order_text(summary));
  text += fmt::format("in {}:\n", directory.string());
  const auto list = [&text](const std::filesystem::path& file, const char* what) {
    if (std::filesystem::exists(file)) text += fmt::format("  {:<16}{}\n", file.filename().string(), what);
  };
  list(files.summary(), "all numbers, with their errors");
  list(files.observables(), curves_of(files.observables()).c_str());
  list(files.recorded(), "every rod, frame by frame");
  list(files.movie(), "the film");
  const std::string where = shell_word(directory.string());
  text += fmt::format("next: shaken plot {}", where);
  if (std::filesystem::exists(files.recorded())) {
    text += fmt::format(";  shaken movie {} --frame last", where);
  }
  return text + "\n";
}

}  // namespace shaken::run
