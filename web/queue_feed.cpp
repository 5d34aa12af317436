#include "web/queue_feed.h"

#include <exception>
#include <utility>
#include <vector>

#include "base/job_state.h"
#include "web/json_reply.h"

namespace shaken::web {
namespace {

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
  Json all = Json::object(), jobs = Json::array();
  std::vector<std::string> paths{"/v1/status", "/v1/sweeps"};
  for (const std::string& state : words_of(has_worker)) paths.push_back("/v1/jobs?state=" + state);
  for (const std::string& path : paths) {
    const Result<std::string> answer = daemon_.get(path);
    if (!answer) return text_of({{"error", answer.error().message}});
    const Json body = Json::parse(*answer, nullptr, false);
    if (path == "/v1/status") {
      all["status"] = body;
      all["status"].erase("uptime_s");  // or each would differ from the one before
    } else if (path == "/v1/sweeps") {
      all["sweeps"] = body.at("sweeps");
    } else {
      jobs.insert(jobs.end(), body.at("jobs").begin(), body.at("jobs").end());
    }
  }
  std::set<std::string> running;
  for (const Json& job : jobs) running.insert(job.value("id", ""));
  all["jobs"] = std::move(jobs);
  running_(running);
  return text_of(all);
}

void QueueFeed::poll(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::string now;
    try {
      now = asked();
    } catch (const std::exception& problem) {
      now = text_of({{"error", std::string("what the daemon answers is not understood: ") + problem.what()}});
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
