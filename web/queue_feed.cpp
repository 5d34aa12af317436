#include "web/queue_feed.h"

#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

namespace shaken::web {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSeldom = 60;
/// After which nobody looks any more: a page waits again each second.
constexpr int kLooksOn = 5;

}  // namespace

QueueFeed::QueueFeed(const DaemonLink& daemon, std::function<void(const std::set<std::string>&)> running,
                     std::chrono::milliseconds every)
    : daemon_(daemon), running_(std::move(running)), every_(every) {
  thread_ = std::jthread([this](const std::stop_token& stop) { poll(stop); });
}

QueueFeed::~QueueFeed() = default;

std::string QueueFeed::asked() {
  Json all = Json::object();
  for (const auto& [key, path] : {std::pair{"status", "/v1/status"},
                                  {"sweeps", "/v1/sweeps"},
                                  {"jobs", "/v1/jobs?state=running"},
                                  {"stopping", "/v1/jobs?state=stopping"}}) {
    const Result<std::string> answer = daemon_.get(path);
    if (!answer) return Json{{"error", answer.error().message}}.dump(-1, ' ', false, Json::error_handler_t::replace);
    const Json body = Json::parse(*answer, nullptr, false);
    if (std::string(key) == "status") {
      all[key] = body;
      all[key].erase("uptime_s");  // or each would differ from the one before
    } else if (body.is_object() && !body.empty()) {
      all[key] = *body.begin();
    }
  }
  std::set<std::string> running;
  Json jobs = all.value("jobs", Json::array());
  for (const Json& job : all.value("stopping", Json::array())) jobs.push_back(job);
  for (const Json& job : jobs) running.insert(job.value("id", ""));
  all["jobs"] = std::move(jobs);
  all.erase("stopping");
  running_(running);
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void QueueFeed::poll(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::string now;
    try {
      now = asked();
    } catch (const std::exception& problem) {
      now = Json{{"error", std::string("what the daemon answers is not understood: ") + problem.what()}}.dump(
          -1, ' ', false, Json::error_handler_t::replace);
    }
    std::unique_lock lock(mutex_);
    is_stale_ = false;
    if (now != newest_) {
      newest_ = std::move(now);
      ++version_;
    }
    news_.notify_all();
    const bool is_looked_at = Clock::now() - looked_at_ < kLooksOn * every_;
    news_.wait_for(lock, stop, (is_looked_at ? 1 : kSeldom) * every_, [&] { return is_stale_; });
  }
}

std::optional<std::string> QueueFeed::wait(std::int64_t& seen, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  const auto now = Clock::now();
  if (now - std::exchange(looked_at_, now) >= kLooksOn * every_) {
    is_stale_ = true;
    news_.notify_all();
  }
  if (!news_.wait_for(lock, timeout, [&] { return !is_stale_ && version_ != seen; })) return std::nullopt;
  seen = version_;
  return newest_;
}

}  // namespace shaken::web
