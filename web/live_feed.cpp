#include "web/live_feed.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <utility>

#include "proto/channels.h"

namespace shaken::web {
namespace {

/// For which rods are put together after somebody has asked for them.
constexpr std::chrono::seconds kInterest{10};
/// So long may the end take.
constexpr int kWaitMs = 100;

}  // namespace

LiveFeed::LiveFeed(std::unique_ptr<proto::Bus> bus) : bus_(std::move(bus)) {
  if (!bus_) return;
  const auto noting = [this](const auto& message) { note(message); };
  bus_->subscribe<observables_t>(proto::kObservablesChannel, noting, 500);
  bus_->subscribe<defects_t>(proto::kDefectsChannel, noting, 100);
  bus_->subscribe<frame_static_t>(proto::kFrameStaticChannel, noting, 100);
  bus_->subscribe<posts_t>(proto::kPostsChannel, noting, 100);
  bus_->subscribe<sizes_t>(proto::kSizesChannel, noting, 100);
  bus_->subscribe<frame_t>(proto::kFrameChannel, noting, 500);
  thread_ = std::jthread([this](const std::stop_token& stop) { listen(stop); });
}

LiveFeed::~LiveFeed() = default;

void LiveFeed::listen(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    try {
      bus_->handle(kWaitMs);
    } catch (const std::exception& problem) {  // of one message: the next may do
      std::fprintf(stderr, "shaken-web: a live message was lost: %s\n", problem.what());
    }
  }
}

void LiveFeed::take(Run& run, const observables_t& message) {
  ++run.count.observables;
  run.observables = message;
  if (std::isfinite(message.order)) run.order.add(message.sim_time_s, message.order);
}

void LiveFeed::take(Run& run, const defects_t& message) {
  ++run.count.defects;
  run.defects = message;
}

void LiveFeed::take(Run& run, const frame_t& message) {
  if (Clock::now() > run.looked_at + kInterest) return;
  run.rods.note(message);
  run.count.frames = run.rods.received();
}

void LiveFeed::keep(const std::set<std::string>& runs) {
  const std::lock_guard lock(mutex_);
  std::erase_if(runs_, [&](const auto& entry) { return !runs.contains(entry.first); });
  for (const std::string& run : runs) {
    const auto [place, is_new] = runs_.try_emplace(run);
    if (is_new) place->second.rods.select(run);
  }
}

LiveNews LiveFeed::wait(const std::string& run, LiveSeen& seen, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  const auto has_news = [&] {
    const auto place = runs_.find(run);
    if (place == runs_.end()) return false;
    place->second.looked_at = Clock::now();
    const LiveSeen& now = place->second.count;
    return now.frames != seen.frames || now.observables != seen.observables || now.defects != seen.defects;
  };
  if (!news_.wait_for(lock, timeout, has_news)) return {};
  const Run& found = runs_.at(run);
  LiveNews news;
  if (found.count.frames != seen.frames) news.frame = found.rods.newest();
  if (found.count.observables != seen.observables) news.observables = found.observables;
  if (found.count.defects != seen.defects) news.defects = found.defects;
  seen = found.count;
  return news;
}

std::shared_ptr<const client::RodFrame> LiveFeed::next_frame(const std::string& run,
                                                             std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  const auto begin = runs_.find(run);
  if (begin == runs_.end()) return nullptr;
  const std::int64_t before = begin->second.count.frames;  // the newest of these may be old: nobody has looked
  const auto has_come = [&] {
    const auto place = runs_.find(run);
    if (place == runs_.end()) return false;
    place->second.looked_at = Clock::now();
    return place->second.count.frames != before;
  };
  return news_.wait_for(lock, timeout, has_come) ? runs_.at(run).rods.newest() : nullptr;
}

client::History LiveFeed::order(const std::string& run) const {
  const std::lock_guard lock(mutex_);
  const auto place = runs_.find(run);
  return place == runs_.end() ? client::History() : place->second.order;
}

}  // namespace shaken::web
