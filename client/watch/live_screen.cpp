#include "client/watch/live_screen.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace shaken::client {
namespace {

constexpr std::chrono::milliseconds kShortestPause{100};
constexpr std::size_t kMostBytesPerSecond = 1'500'000;
constexpr std::size_t kMostRemoteBytesPerSecond = 150'000;
/// The bytes of one key follow each other faster than this.
constexpr std::chrono::milliseconds kWithinAKey{50};

std::vector<DefectMark> marks_of(const LiveJobs& jobs, const std::string& id) {
  std::vector<DefectMark> marks;
  for (const LiveJob& job : jobs.jobs()) {
    if (job.id != id || !job.defects) continue;
    const defects_t& message = *job.defects;
    for (std::size_t i = 0; i < message.charge.size(); ++i) {
      if (!std::isfinite(message.x_mm[i]) || !std::isfinite(message.y_mm[i])) continue;
      marks.push_back({message.x_mm[i], message.y_mm[i], message.charge[i] > 0});
    }
  }
  return marks;
}

}  // namespace

std::chrono::milliseconds pause_after(std::size_t bytes, bool is_remote) {
  const std::size_t rate = is_remote ? kMostRemoteBytesPerSecond : kMostBytesPerSecond;
  return std::max(kShortestPause, std::chrono::milliseconds(1000 * bytes / rate));
}

std::chrono::milliseconds LiveScreen::draw(const LiveJobs& jobs, const std::string& title, const std::string& note,
                                           TerminalSize size) {
  if (!steering_.paused) {
    steering_.job = job_to_show(steering_.job, jobs);
    rods_.select(steering_.job);
    shown_ = rods_.newest();
    defects_ = marks_of(jobs, steering_.job);
  }
  if (shown_) steering_.automatic = automatic_colouring(shown_->order, steering_.automatic);
  if (std::exchange(steering_.redraw, false)) writer_.forget();
  const WatchContent content{.jobs = jobs,
                             .steering = steering_,
                             .rods = shown_.get(),
                             .defects = defects_,
                             .title = title,
                             .note = note,
                             .depth = settings_.depth};
  const std::string bytes = writer_.update(watch_cells(content, size.columns, size.lines));
  if (!session_.write(bytes)) writer_.forget();
  return pause_after(bytes.size(), settings_.is_remote);
}

bool LiveScreen::wait(int bus_descriptor, std::chrono::milliseconds time, const LiveJobs& jobs) {
  if (keys_.is_waiting()) time = std::min(time, kWithinAKey);
  std::array<pollfd, 3> descriptors{{{session_.has_keys() ? STDIN_FILENO : -1, POLLIN, 0},
                                     {session_.resize_descriptor(), POLLIN, 0},
                                     {bus_descriptor, POLLIN, 0}}};
  if (poll(descriptors.data(), descriptors.size(), static_cast<int>(std::max<std::int64_t>(0, time.count()))) < 0) {
    return false;  // a signal; the caller knows which
  }
  const bool is_resized = descriptors[1].revents != 0;
  if (is_resized) session_.take_resizes();
  const Clock::time_point now = Clock::now();
  std::vector<Key> keys;
  if (descriptors[0].revents != 0) {
    keys = keys_.add(session_.read());
    typed_at_ = now;
  } else if (now - typed_at_ >= kWithinAKey) {
    keys = keys_.flush();
  }
  obey(keys, jobs);
  return is_resized || !keys.empty();
}

void LiveScreen::obey(const std::vector<Key>& keys, const LiveJobs& jobs) {
  const std::string before = steering_.job;
  const Vec2 period = shown_ ? shown_->cell.period() : Vec2(1, 1);
  for (const Key& key : keys) steering_ = steered(steering_, key, choices(jobs), period);
  // What is held is the picture of the run that was shown.
  if (steering_.job != before) steering_.paused = false;
  if (std::exchange(steering_.suspend, false)) {
    session_.suspend();
    writer_.forget();
  }
}

}  // namespace shaken::client
