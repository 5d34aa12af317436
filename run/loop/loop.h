#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/core/result.h"
#include "run/files/directory.h"
#include "run/files/progress.h"
#include "run/live/pace.h"
#include "run/loop/movie_process.h"
#include "scene/keys/run_plan.h"

namespace shaken::run {

/// Wall-clock time from one checkpoint to the next; CPU time of a run that is alone.
inline constexpr WallSeconds kCheckpointEvery{30};

/// How, not what, to run: nothing here changes a result.
struct RunOptions {
  std::filesystem::path directory;
  bool is_own_scene = false;           ///< the plan was read from the scene.json there, and is unchanged
  std::string job_id;                  ///< in live messages
  std::string label;                   ///< the swept parameters, for viewers
  std::optional<std::string> lcm_url;  ///< none: no live state
  int n_threads = 1;                   ///< that share each tick; the results do not depend on it
  WallSeconds checkpoint_every = kCheckpointEvery;
  WallSeconds progress_every{0.5};
  const std::atomic<bool>* stop = nullptr;  ///< once true, the run ends with a checkpoint; null: it never does
};

struct RunCallbacks {
  std::function<void()> on_owned;                    ///< the directory is ours, nothing is written yet
  std::function<void(const Progress&)> on_progress;  ///< about twice a second, and at the end
  /// Draws the finished run, if the plan wants a movie. Null: none is drawn. A failure does not lose the run.
  /// What it is given takes the share that is drawn and the wall seconds to the end.
  std::function<Result<void>(const OnDrawn&)> make_movie;
};

enum class RunState {
  kDone,
  kFailed,
  kNoRoom,        ///< failed for want of room on the disk
  kSystemFailed,  ///< failed by an error of the disk, of memory or threads, which may pass
  kStopped,
};

struct RunOutcome {
  RunState state = RunState::kDone;
  std::string message;  ///< why it failed; empty otherwise
};

/// Runs the plan in its directory from start, or from the last whole checkpoint, to end, and fills the directory.
/// A directory whose run is done already is left as it is; one that holds another scene's run is refused. Logs through
/// spdlog's default logger.
RunOutcome run(const scene::RunPlan& plan, const RunOptions& options, const RunCallbacks& callbacks = {});

}  // namespace shaken::run
