#include "server/slurm/array_task.h"

namespace shaken::server::slurm {

void ArrayTask::update(const QueuedTask* listed) {
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

void ArrayTask::cancel(bool if_waits) {
  cancel_ = true;
  if_waits_ = if_waits;
}

bool ArrayTask::was_revoked() const {
  return was_cancelled_ || words_ == "NODE_FAIL" || words_ == "PREEMPTED" || words_ == "BOOT_FAIL";
}

}  // namespace shaken::server::slurm
