#include "client/live/mean_order.h"

#include "base/files.h"
#include "client/live/target.h"
#include "run/files/directory.h"

namespace shaken::client {

std::optional<MeanOrder> mean_order(const Json& job) {
  if (text_of(job, "state") != "done") return std::nullopt;
  const auto text = read_file(run::RunDirectory{text_of(job, "directory")}.summary());
  const Json summary = text ? Json::parse(*text, nullptr, false) : Json();
  const Json::json_pointer mean("/order/mean");
  if (!summary.is_object() || !summary.contains(mean) || !summary.at(mean).is_number()) return std::nullopt;
  const Json steady = summary.value("steady", Json(true));  // a summary that does not say is of no present version
  return MeanOrder{summary.at(mean).get<double>(),
                   steadiness_of(steady.is_boolean() ? std::optional(steady.get<bool>()) : std::nullopt)};
}

}  // namespace shaken::client
