#include "web/cost.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/process.h"
#include "base/scratch_folder.h"
#include "web/json_reply.h"

namespace shaken::web {

http::Reply CostEstimates::answer(const http::Request& request) {
  const Json body = Json::parse(request.body, nullptr, false);
  const bool is_whole = body.is_object() && body.contains("text") && body["text"].is_string() &&
                        (!body.contains("replicas") || body["replicas"].is_number_integer());
  if (!is_whole) return refusal(400, R"(expected {"text": a scene or sweep, "replicas": a number, if any})");
  const std::unique_lock lock(busy_, std::try_to_lock);
  if (!lock) return refusal(429, "the cost of another scene is being estimated: try again");
  const ScratchFolder folder;
  const std::filesystem::path scene = folder.path() / "scene.json";
  if (const auto written = write_file(scene, body["text"].get<std::string>()); !written) {
    return refusal(507, written.error().message);
  }
  std::vector<std::string> command{client_.string(), "submit", scene.string(), "--dry-run", "--json"};
  if (body.contains("replicas")) command.push_back("--replicas=" + std::to_string(body["replicas"].get<int>()));
  const Captured captured = run_captured(command, CaptureLimits{.time = limit_, .stop = stop_});
  if (captured.cut_short) {
    return refusal(504, "the cost is not known: the rods were not placed and stepped within " +
                            std::to_string(limit_.count() / 1000) + " s");
  }
  if (captured.exit_code != 0) return refusal(422, captured.output);
  const Json answer = Json::parse(captured.output, nullptr, false);
  if (!answer.is_object() || !answer.contains("estimate")) return refusal(500, "shaken: " + captured.output);
  return json_reply(answer["estimate"]);
}

}  // namespace shaken::web
