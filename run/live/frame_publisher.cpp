#include "run/live/frame_publisher.h"

#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "proto/bus.h"

namespace shaken::run {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kStaticPeriod{2};
constexpr std::chrono::seconds kPatienceAtEnd{1};
/// Chunks of a large frame follow each other at this distance, so that receivers with small buffers keep up.
constexpr std::chrono::microseconds kChunkPause{200};

/// What waits to be sent: at most one of each kind.
struct Outbox {
  std::optional<proto::Frame> frame;
  std::optional<observables_t> observables;
  std::optional<defects_t> defects;
  bool empty() const { return !frame && !observables && !defects; }
};

}  // namespace

/// Outlives the publisher if its thread hangs in the network.
struct FramePublisher::Shared {
  std::mutex mutex;
  std::condition_variable changed;
  Outbox outbox;
  bool closing = false;
  bool finished = false;
  std::atomic<std::int64_t> n_frames{0};
};

namespace {

/// The thread's own part: numbers the messages and puts them on the bus.
class Sender {
 public:
  Sender(std::unique_ptr<proto::Bus> bus, std::string job_id, FramePublisher::Constants constants)
      : bus_(std::move(bus)), job_id_(std::move(job_id)), constants_(std::move(constants)) {}

  void send_static(double sim_time) {
    const auto send_at = [&](const char* channel, auto& message) {
      message.sim_time_s = sim_time;
      send(channel, message, static_sequence_);
    };
    send_at(proto::kFrameStaticChannel, constants_.cell);
    if (constants_.sizes) send_at(proto::kSizesChannel, *constants_.sizes);
    if (constants_.posts) send_at(proto::kPostsChannel, *constants_.posts);
    ++static_sequence_;
  }
  bool send(proto::Frame& frame) {
    frame.utime = utime_now();
    frame.job_id = job_id_;
    frame.sequence = frame_sequence_++;
    bool first = true;
    for (const frame_t& chunk : proto::encode_frame(frame)) {
      if (!std::exchange(first, false)) std::this_thread::sleep_for(kChunkPause);
      if (!bus_->publish(proto::kFrameChannel, chunk)) return false;
    }
    return true;
  }
  void send(observables_t& message) { send(proto::kObservablesChannel, message, observables_sequence_++); }
  void send(defects_t& message) { send(proto::kDefectsChannel, message, defects_sequence_++); }

 private:
  template <class Message>
  void send(const char* channel, Message& message, std::int64_t sequence) {
    message.utime = utime_now();
    message.job_id = job_id_;
    message.sequence = sequence;
    bus_->publish(channel, message);  // may be lost, as everything on this way
  }

  std::unique_ptr<proto::Bus> bus_;
  std::string job_id_;
  FramePublisher::Constants constants_;
  std::int64_t static_sequence_ = 0;
  std::int64_t frame_sequence_ = 0;
  std::int64_t observables_sequence_ = 0;
  std::int64_t defects_sequence_ = 0;
};

}  // namespace

FramePublisher::FramePublisher(const std::string& lcm_url, const std::string& job_id, const Constants& constants)
    : shared_(std::make_shared<Shared>()) {
  const auto publish = [shared = shared_, lcm_url, job_id, constants] {
    if (auto bus = proto::Bus::open(lcm_url)) {
      Sender sender(std::move(bus).value(), job_id, constants);
      Clock::time_point next_static = Clock::now();
      double sim_time = 0;
      for (bool closing = false; !closing;) {
        Outbox outbox;
        {
          std::unique_lock lock(shared->mutex);
          shared->changed.wait_until(lock, next_static, [&] { return shared->closing || !shared->outbox.empty(); });
          outbox = std::exchange(shared->outbox, {});
          closing = shared->closing;
        }
        if (outbox.observables) sim_time = outbox.observables->sim_time_s;
        if (Clock::now() >= next_static) {
          sender.send_static(sim_time);
          next_static = Clock::now() + kStaticPeriod;
        }
        if (outbox.frame && sender.send(*outbox.frame)) ++shared->n_frames;
        if (outbox.observables) sender.send(*outbox.observables);
        if (outbox.defects) sender.send(*outbox.defects);
      }
    } else {
      spdlog::warn("no live state: {}", bus.error().message);
    }
  };
  // no result depends on live state: whatever is thrown ends that alone
  const auto work = [shared = shared_, publish] {
    try {
      publish();
    } catch (const std::exception& problem) {
      spdlog::warn("no live state any more: {}", problem.what());
    }
    const std::lock_guard lock(shared->mutex);
    shared->finished = true;
    shared->changed.notify_all();
  };
  try {
    std::thread(work).detach();  // the destructor waits for `finished`, but not for ever
  } catch (const std::system_error& problem) {
    spdlog::warn("no live state: {}", problem.what());
    shared_->finished = true;
  }
}

FramePublisher::~FramePublisher() {
  std::unique_lock lock(shared_->mutex);
  shared_->closing = true;
  shared_->changed.notify_all();
  shared_->changed.wait_for(lock, kPatienceAtEnd, [&] { return shared_->finished; });
}

void FramePublisher::offer(proto::Frame frame) {
  const std::lock_guard lock(shared_->mutex);
  shared_->outbox.frame = std::move(frame);
  shared_->changed.notify_all();
}

void FramePublisher::offer(observables_t message) {
  const std::lock_guard lock(shared_->mutex);
  shared_->outbox.observables = std::move(message);
  shared_->changed.notify_all();
}

void FramePublisher::offer(defects_t message) {
  const std::lock_guard lock(shared_->mutex);
  shared_->outbox.defects = std::move(message);
  shared_->changed.notify_all();
}

std::int64_t FramePublisher::n_frames() const { return shared_->n_frames; }

}  // namespace shaken::run
