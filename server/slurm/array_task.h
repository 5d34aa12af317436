#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "server/slurm/squeue.h"

namespace shaken::server::slurm {

/// One task of a job array: what the answers of squeue say of it, and what is asked of it. It is over once two answers
/// in a row say so.
class ArrayTask {
 public:
  /// Takes an answer of squeue; null where the task is not in it.
  void update(const QueuedTask* listed) {
    using enum QueuedTask::Stage;
    cancelled_ = false;
    if (listed == nullptr || listed->stage == kOver) {
      if (times_over_++ == 0) over_since_ = Clock::now();
      stage_ = kOver;
      words_ = listed != nullptr ? listed->state : "Slurm does not know it any more";
      return;
    }
    times_over_ = 0;
    stage_ = listed->stage;
    words_ = stage_ == kWaiting ? listed->reason : "";
    if (if_waits_ && stage_ == kWorking) cancel_ = false;  // its file of stops tells it
  }
  /// There is a report of it: it has begun, once at least.
  void set_reported() { reported_ = true; }
  /// It is to be cancelled; `if_waits`: only if it still waits.
  void cancel(bool if_waits) {
    cancel_ = true;
    if_waits_ = if_waits;
  }
  /// Whether the next scancel of that kind is to name it.
  bool is_to_cancel(bool if_waits) const { return cancel_ && if_waits_ == if_waits && !cancelled_ && times_over_ == 0; }
  /// scancel names it. Returns whether that is the first time.
  bool set_cancelled() {
    cancelled_ = true;
    return !std::exchange(was_cancelled_, true);
  }

  QueuedTask::Stage stage() const { return stage_; }
  /// Slurm's, for why it waits or how it ended.
  const std::string& words() const { return words_; }
  bool has_reported() const { return reported_; }
  bool is_over() const { return times_over_ >= 2; }
  /// So that its last words can be seen, which may take `delay` where they go over a network.
  bool is_over_for(std::chrono::milliseconds delay) const { return is_over() && Clock::now() >= over_since_ + delay; }
  /// Whether what ran in it has not caused its end.
  bool was_revoked() const {
    return was_cancelled_ || words_ == "NODE_FAIL" || words_ == "PREEMPTED" || words_ == "BOOT_FAIL";
  }

 private:
  using Clock = std::chrono::steady_clock;
  QueuedTask::Stage stage_ = QueuedTask::Stage::kWaiting;
  std::string words_;
  int times_over_ = 0;              ///< answers in a row in which it was over, or was not there
  Clock::time_point over_since_{};  ///< the first of them
  bool cancel_ = false;             ///< it is to be cancelled
  bool if_waits_ = false;           ///< but only if it still waits
  bool cancelled_ = false;          ///< by us, since the last answer
  bool was_cancelled_ = false;      ///< by us, ever
  bool reported_ = false;
};

}  // namespace shaken::server::slurm
