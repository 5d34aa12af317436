// SPDX-License-Identifier: MIT
// The runs of a selection, and how they are brought to their end by a daemon.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "base/progress_line.h"
#include "client/api_client.h"
#include "client/console.h"
#include "client/own_daemon.h"
#include "client/target.h"
#include "client/waiting_reasons.h"
#include "study/selection.h"

namespace shaken::study {

/// Tells what the runs that are not done yet will cost on so many cores (see study_cost()), and asks where there is
/// somebody to ask, unless `yes`. Whether to start.
bool is_agreed_to(const Selection& selection, const std::filesystem::path& runs_folder, int cores, bool yes,
                  client::Console& console);

/// The sweeps that are needed in the queue of a daemon, which is started where none is at work and goes with this
/// object.
class Schedule {
 public:
  Schedule(const Selection& selection, std::filesystem::path root, client::Console& console);

  /// Queues every sweep.
  void submit();
  /// Calls `draw` for each figure as soon as its runs have ended, with a line of progress meanwhile, and one for each
  /// reason that keeps runs waiting. A daemon that goes
  /// away is started again. False if it was interrupted, a run has not come to its end, or `draw` said so.
  bool wait(const InterruptGuard& guard, const std::function<bool(const PaperFigure&)>& draw);
  /// Jobs that others have queued with a daemon that was started here come to their end before it goes.
  void let_others_finish(const InterruptGuard& guard);

 private:
  struct Queued {
    const NamedSweep* sweep;
    client::Target target;
  };
  static bool has_ended(const Queued& queued);
  bool can_be_drawn(const PaperFigure& figure) const;
  void refresh_all();
  /// Names the jobs that have ended otherwise than done; false if there are any.
  bool all_done() const;
  void show_progress(ProgressLine& progress, bool is_last = false);
  void tell_reasons(ProgressLine& progress);

  const Selection& selection_;
  std::filesystem::path root_;
  client::Console& console_;
  std::optional<client::OwnDaemon> daemon_;
  std::optional<client::ApiClient> session_;
  std::vector<Queued> queued_;
  client::WaitingReasons reasons_;
  int n_restarts_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::optional<double> first_done_;  ///< work that was done when it was first looked at
};

}  // namespace shaken::study
