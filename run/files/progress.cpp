#include "run/files/progress.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/files.h"

namespace shaken::run {
namespace {

/// JSON has no NaN.
nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

double number_or_nan(const nlohmann::json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace

Result<void> write_progress(const std::filesystem::path& file, const Progress& progress) {
  const nlohmann::ordered_json json{
      {"state", progress.state},
      {"message", progress.message},
      {"pid", progress.pid},
      {"n_rods", progress.n_rods},
      {"fraction", progress.fraction()},
      {"sim_time_s", progress.sim_time},
      {"sim_time_total_s", progress.sim_time_total},
      {"sim_rate", progress.sim_rate},
      {"eta_s", progress.eta},
      {"drawn", progress.drawn},
      {"order", number_or_null(progress.order)},
      {"order_running_mean", number_or_null(progress.order_running_mean)},
      {"max_overlap_mm", progress.max_overlap},
  };
  constexpr auto kReplaceBadUtf8 = nlohmann::ordered_json::error_handler_t::replace;
  return write_file_atomically(file, json.dump(2, ' ', false, kReplaceBadUtf8) + "\n");
}

Result<Progress> read_progress(const std::filesystem::path& file) {
  const std::string text = SHAKEN_TRY(read_file(file));
  try {
    const auto json = nlohmann::json::parse(text);
    Progress progress;
    json.at("state").get_to(progress.state);
    json.at("message").get_to(progress.message);
    json.at("pid").get_to(progress.pid);
    json.at("n_rods").get_to(progress.n_rods);
    json.at("sim_time_s").get_to(progress.sim_time);
    json.at("sim_time_total_s").get_to(progress.sim_time_total);
    json.at("sim_rate").get_to(progress.sim_rate);
    json.at("eta_s").get_to(progress.eta);
    progress.drawn = json.value("drawn", 0.0);  // older versions did not tell it
    progress.order = number_or_nan(json.at("order"));
    progress.order_running_mean = number_or_nan(json.at("order_running_mean"));
    json.at("max_overlap_mm").get_to(progress.max_overlap);
    return progress;
  } catch (const nlohmann::json::exception& problem) {
    return Error{file.string() + " is not a progress file: " + problem.what()};
  }
}

}  // namespace shaken::run
