#include "run/loop/loop.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <exception>
#include <memory>
#include <new>
#include <system_error>

#include "analysis/order.h"
#include "base/clock.h"
#include "base/files.h"
#include "base/text.h"
#include "proto/cell_codec.h"
#include "run/files/content_hash.h"
#include "run/files/done.h"
#include "run/live/frame_publisher.h"
#include "run/loop/open_run.h"
#include "run/loop/saved_run.h"
#include "run/loop/slice.h"
#include "run/loop/summary_of_run.h"
#include "run/loop/trouble_file.h"
#include "scene/canonical.h"
#include "scene/length.h"

namespace shaken::run {
namespace {

std::string scene_text(const scene::RunPlan& plan) { return scene::to_json(plan).dump(2) + "\n"; }

RunOutcome failure(const Error& error) {
  const RunState state = means_no_room(error.message) ? RunState::kNoRoom
                         : may_pass(error)            ? RunState::kSystemFailed
                                                      : RunState::kFailed;
  return {state, error.message};
}

/// One run from where it stands to its end.
class Loop {
 public:
  Loop(const scene::RunPlan& plan, const RunOptions& options, const RunCallbacks& callbacks, OpenRun run)
      : plan_(plan),
        options_(options),
        callbacks_(callbacks),
        directory_{options.directory},
        run_id_(scene::run_id(plan)),
        run_(std::move(run)),
        checkpoint_tick_(run_.simulation.tick()),
        begin_(WallClock::now()),
        cpu_begin_(shaken::cpu_seconds()),
        started_(utc_now()),
        rate_(run_.simulation.time(), begin_),
        progress_pacer_(options.progress_every, begin_),
        checkpoint_pacer_(options.checkpoint_every,
                          begin_ + std::chrono::duration_cast<WallClock::duration>(options.checkpoint_every)),
        frame_pacer_(live_period(), begin_),
        observables_pacer_(live_period(), begin_),
        defects_pacer_(live_period(), begin_) {
    const World& world = run_.simulation.world();
    progress_.pid = static_cast<int>(getpid());
    progress_.n_rods = static_cast<int>(world.rods.size());
    aim_at(scene::next_end(plan, run_.simulation.tick()));
    if (plan.stream && options.lcm_url) {
      const Cell cell = world.cell();
      FramePublisher::Constants constants{proto::encode_cell(cell, world.rods.size(), options.label)};
      if (!cell.posts.centres.empty()) constants.posts = proto::encode_posts(cell.posts);
      if (!cell.species_of_shape.empty()) constants.sizes = proto::encode_sizes(cell.species_of_shape);
      publisher_ = std::make_unique<FramePublisher>(*options.lcm_url, options.job_id, constants);
    }
  }

  RunOutcome run(bool fresh) {
    if (fresh) {
      if (auto done = sample(); !done) return finish_without_disk(done.error());
      // the run that it starts from may be extended or removed, and what was compressed need not be so again
      if (plan_.start || is_compressed(plan_.system.start)) {
        if (auto done = checkpoint(); !done) return finish_without_disk(done.error());
      }
    }
    while (!may_end()) {
      aim_at(scene::next_end(plan_, tick() + 1));
      if (const auto outcome = go_on()) return *outcome;
    }
    return finish_done();
  }

  /// Writes and passes on progress.json. A disk that refuses it shows in the checkpoint, so that is not repeated here.
  void report(const std::string& state, const std::string& message = "") {
    rate_.update(run_.simulation.time(), WallClock::now());
    progress_.state = state;
    progress_.message = message;
    progress_.sim_time = run_.simulation.time();
    progress_.sim_rate = rate_.rate();
    progress_.eta = state == "running" ? rate_.eta(progress_.sim_time_total) : -1.0;
    progress_.order =
        analysis::nematic_order(run_.simulation.world().cell(), run_.simulation.snapshot().director).order;
    progress_.order_running_mean = run_.measurements.order_running_mean();
    progress_.max_overlap = run_.simulation.world().counters.max_overlap();
    if (auto done = write_progress(directory_.progress(), progress_); !done) spdlog::warn("{}", done.error().message);
    if (callbacks_.on_progress) callbacks_.on_progress(progress_);
  }

  const Progress& progress() const { return progress_; }

 private:
  Tick tick() const { return run_.simulation.tick(); }

  bool may_end() const {
    return scene::next_end(plan_, tick()) == tick() &&
           scene::is_long_enough(plan_, tick(), plan_.until ? known_order() : std::nullopt);
  }

  std::optional<scene::KnownOrder> known_order() const {
    const auto order = run_.measurements.reduce(run_.simulation.time()).order;
    return order ? std::optional(scene::KnownOrder{shown_error(*order), order->steady}) : std::nullopt;
  }

  void aim_at(Tick end) {
    end_ = end;
    progress_.sim_time_total = static_cast<double>(std::max(end, scene::most_ticks(plan_))) * plan_.system.dt;
  }

  /// To end_. What came of the run if it does not get there.
  std::optional<RunOutcome> go_on() {
    Slice slice(publisher_ ? std::min(kLongSlice, live_period() / 2) : kLongSlice);  // live frames keep their rate too
    while (tick() < end_) {
      const auto before = WallClock::now();
      const Tick first = tick();
      if (const auto trouble = run_.simulation.advance_to(std::min({end_, run_.next_due(first + 1), slice.end(first)})))
        return finish_in_trouble(*trouble);
      const auto now = WallClock::now();
      slice.note(tick() - first, now - before);

      if (auto done = sample(); !done) return finish_without_disk(done.error());
      publish_observables(now);
      if (progress_pacer_.take(now)) report("running");
      const bool stop = options_.stop != nullptr && *options_.stop;
      if (stop || (checkpoint_pacer_.take(now) && tick() < end_)) {
        if (auto done = checkpoint(); !done) return finish_without_disk(done.error());
      }
      if (stop && tick() < end_) return finish_stopped();
    }
    return std::nullopt;
  }

  WallSeconds live_period() const { return WallSeconds(plan_.stream ? 1.0 / plan_.stream->rate : 1.0); }
  double cpu_seconds() const { return run_.cpu_before + shaken::cpu_seconds() - cpu_begin_; }
  double wall_seconds() const { return run_.wall_before + WallSeconds(WallClock::now() - begin_).count(); }

  /// Measures, records and publishes what is due at this tick.
  Result<void> sample() {
    const bool record = run_.recording && run_.recording->due(tick());
    const bool measure = run_.measurements.next_due(tick()) == tick();
    const bool show = publisher_ && frame_pacer_.take(WallClock::now());
    if (!record && !measure && !show) return {};
    const Snapshot snapshot = run_.simulation.snapshot();
    if (measure) run_.measure(plan_, snapshot);
    if (record) {
      SHAKEN_TRY(run_.frames->append(shaken::run::record(snapshot)));
    }
    if (show) publish_frame(snapshot);
    const DefectSample* defects = run_.measurements.last_defects();
    if (publisher_ && defects != nullptr && defects->tick == tick() && defects_pacer_.take(WallClock::now())) {
      publisher_->offer(make_defects(*defects));
    }
    return {};
  }

  void publish_frame(const Snapshot& snapshot) { publisher_->offer(make_frame(run_.simulation.world(), snapshot)); }

  void publish_observables(WallClock::time_point now) {
    if (!publisher_ || !observables_pacer_.take(now)) return;
    publisher_->offer(make_observables(run_.simulation.world(), run_.simulation.snapshot(), progress_));
  }

  /// Frames first: no checkpoint may know of one that the disk does not.
  Result<void> checkpoint() {
    if (run_.frames) {
      SHAKEN_TRY(run_.frames->sync());
    }
    Result<void> done = write_checkpoint(directory_, run_id_, make_checkpoint(run_, cpu_seconds(), wall_seconds()));
    if (done) checkpoint_tick_ = tick();
    return done;
  }

  Summary summarize(const Reduction& reduction) const {
    Summary summary =
        summary_of(plan_, run_, reduction, publisher_ ? std::optional(publisher_->n_frames()) : std::nullopt);
    summary.cpu_seconds = cpu_seconds();
    summary.wall_seconds = wall_seconds();
    summary.started = started_;
    return summary;
  }

  /// trajectory.h5 of all frames so far. Those that were recorded are in it, or it has failed: what they were recorded
  /// in is removed afterwards.
  Result<void> write_frames() {
    if (!run_.frames) return {};
    const std::size_t n = run_.frames->n_frames();
    const auto opened = [n](const std::filesystem::path& file) -> Result<TrajectoryReader> {
      Result<TrajectoryReader> frames = TrajectoryReader::open(file);
      if (!frames || frames->n_frames() == n) return frames;
      return Error{fmt::format("{} has {} frames instead of {}", file.string(), frames->n_frames(), n)};
    };
    const TrajectoryReader frames = SHAKEN_TRY(opened(directory_.frames()));
    const TrajectoryHeader header = trajectory_header(run_.simulation.world(), scene_text(plan_), provenance_of(plan_));
    SHAKEN_TRY(write_trajectory(directory_.trajectory(), header, frames.recorded()));
    assume_whole(directory_.trajectory());  // the hash in summary.json is of the one before
    const Result<TrajectoryReader> written = opened(directory_.trajectory());
    return written ? Result<void>() : written.error();
  }

  /// Observables and summary, in this order: a summary that says "done" is the last word.
  Result<void> write_results(const std::string& state, const std::string& reason, const std::vector<int>& rods) {
    const Reduction reduction = run_.measurements.reduce(run_.simulation.time());
    if (auto done = write_observables(directory_.observables(), reduction.arrays, provenance_of(plan_)); !done)
      return done.error();
    Summary summary = summarize(reduction);
    summary.state = state;
    summary.reason = reason;
    summary.rods = rods;
    if (state != "done") summary.done_before = former_end(directory_, run_id_);
    SHAKEN_TRY(hash_files(state != "stopped", summary));
    if (state == "done" && summary.order) {
      const std::string trouble = why_not_steady(*summary.order, summary.sim_seconds);
      if (!trouble.empty()) spdlog::warn("{}", trouble);
      if (plan_.until && !(shown_error(*summary.order) <= plan_.until->order_sem)) {
        spdlog::warn("S is known to {:.2g}, not to until.order_sem = {:.2g}: until.at_most, {:.4g} s, is over",
                     shown_error(*summary.order), plan_.until->order_sem, plan_.until->at_most);
      }
    }
    return write_summary(directory_.summary(), summary);
  }

  /// `with_frames`: whether trajectory.h5 is of this end.
  Result<void> hash_files(bool with_frames, Summary& summary) const {
    std::vector<std::filesystem::path> written{directory_.observables()};
    if (with_frames && run_.frames) written.push_back(directory_.trajectory());
    for (const auto& file : written) {
      summary.files[file.filename().string()] = SHAKEN_TRY(content_hash(file));
    }
    return {};
  }

  RunOutcome finish_done() {
    if (publisher_) publish_frame(run_.simulation.snapshot());  // what viewers keep showing
    std::error_code ignored;
    std::filesystem::remove(directory_.trouble(), ignored);  // met by a program before this one
    if (auto done = checkpoint(); !done) return finish_without_disk(done.error());
    if (auto done = write_frames(); !done) return finish_without_disk(done.error());
    std::filesystem::remove(directory_.movie(), ignored);  // of the run when it was shorter
    if (auto done = write_results("done", "", {}); !done) return finish_without_disk(done.error());
    std::filesystem::remove(directory_.frames(), ignored);
    progress_.sim_time_total = run_.simulation.time();  // with `until`, it may have been more
    report("running");                                  // all of it; what is left is to draw it
    return {RunState::kDone, ""};
  }

  RunOutcome finish_stopped() {
    if (auto done = write_results("stopped", "asked to stop", {}); !done) return finish_without_disk(done.error());
    report("stopped", "asked to stop");
    return {RunState::kStopped, ""};
  }

  /// The last good checkpoint stays as it is: the trouble can be looked at again from there.
  RunOutcome finish_in_trouble(const NumericalTrouble& trouble) {
    const std::string message = describe(trouble, plan_.system.dt);
    // no flight changes before a tick's last phase, so the world still knows where the rods were one tick before
    const CloseUp before = look_closely(run_.simulation.world(), trouble.tick - 1, trouble.rods);
    if (auto done = write_trouble(directory_.trouble(), plan_, {trouble, checkpoint_tick_, before}); !done) {
      return finish_without_disk(done.error());
    }
    if (auto done = write_frames(); !done) return finish_without_disk(done.error());
    if (auto done = write_results("failed", message, trouble.rods); !done) return finish_without_disk(done.error());
    report("failed", message);
    return {RunState::kFailed, message};
  }

  RunOutcome finish_without_disk(const Error& error) {
    const std::string message =
        error.message + (checkpoint_tick_ > 0 ? "; the run goes on from its last checkpoint when started again"
                                              : "; there is no checkpoint yet: the run begins anew when started again");
    report("failed", message);
    return failure({message, error.code});
  }

  const scene::RunPlan& plan_;
  const RunOptions& options_;
  const RunCallbacks& callbacks_;
  RunDirectory directory_;
  std::string run_id_;
  OpenRun run_;
  Tick end_ = 0;          ///< where the run may end next
  Tick checkpoint_tick_;  ///< of the last sound checkpoint; 0: there is none
  WallClock::time_point begin_;
  double cpu_begin_;
  std::string started_;
  RateMeter rate_;
  Pacer progress_pacer_, checkpoint_pacer_, frame_pacer_, observables_pacer_, defects_pacer_;
  Progress progress_;
  std::unique_ptr<FramePublisher> publisher_;
};

/// Whether the run begins with work.
bool begins_with_compression(const scene::RunPlan& plan) { return !plan.start && is_compressed(plan.system.start); }

struct Opened {
  OpenRun run;
  bool fresh = false;  ///< at tick 0, nothing sampled
};

/// Puts recorded frames aside that no checkpoint fits, rather than writing over them.
void set_aside(const std::filesystem::path& file) {
  const Result<bool> is_there = file_exists(file);
  if (is_there && !*is_there) return;
  std::filesystem::path aside = file;
  aside += ".damaged";
  std::error_code reason;
  std::filesystem::rename(file, aside, reason);
  if (reason) {
    spdlog::warn("cannot put {} aside: {}", file.string(), reason.message());
  } else {
    spdlog::warn("{} is kept as {}", file.string(), aside.string());
  }
}

/// The run from the newest checkpoint that is whole and fits, or a new one.
Result<Opened> open_run(const scene::RunPlan& plan, const RunDirectory& directory, const GoOn& go_on) {
  bool found = false;
  for (const auto& file : directory.checkpoints()) {
    if (!SHAKEN_TRY(file_exists(file))) continue;
    found = true;
    const Result<Checkpoint> checkpoint = read_checkpoint(file, scene::run_id(plan));
    if (!checkpoint && may_pass(checkpoint.error())) return checkpoint.error();  // it may be whole
    if (!checkpoint) {
      spdlog::warn("{}", checkpoint.error().message);
      continue;
    }
    Result<OpenRun> run = resume_run(plan, directory, *checkpoint);
    if (!run && may_pass(run.error())) return run.error();
    if (!run) {
      spdlog::warn("cannot go on from {}: {}", file.string(), run.error().message);
      continue;
    }
    spdlog::info("going on from {} at {:.6f} s", file.string(), run->simulation.time());
    return Opened{std::move(run).value(), false};
  }
  if (found) {
    spdlog::warn("no checkpoint can be used: starting from the beginning");
    set_aside(directory.frames());
    set_aside(directory.trajectory());
  }
  const double cpu_begin = shaken::cpu_seconds();
  OpenRun run = SHAKEN_TRY(start_run(plan, directory, scene_text(plan), go_on));
  if (begins_with_compression(plan))
    spdlog::info("compressed the rods in {:.2f} CPU-s", shaken::cpu_seconds() - cpu_begin);
  return Opened{std::move(run), true};
}

/// Removes what the frames of a run that is done were recorded in, which is of no use any more where trajectory.h5 has
/// them all.
void drop_logged_frames(const RunDirectory& directory) {
  const Result<bool> is_there = file_exists(directory.frames());
  if (is_there && !*is_there) return;
  const Result<TrajectoryReader> logged = TrajectoryReader::open(directory.frames());
  const Result<TrajectoryReader> written = TrajectoryReader::open(directory.trajectory());
  if (logged && written && written->n_frames() >= logged->n_frames()) {
    std::error_code ignored;
    std::filesystem::remove(directory.frames(), ignored);
  } else {
    spdlog::warn("{} stays: {}", directory.frames().string(),
                 !logged    ? logged.error().message
                 : !written ? written.error().message
                            : directory.trajectory().string() + " has fewer frames");
  }
}

/// Says in progress.json too why a run never got going.
void report_end(const RunOptions& options, const RunCallbacks& callbacks, const std::string& state,
                const std::string& message) {
  Progress progress;
  progress.state = state;
  progress.message = message;
  progress.pid = static_cast<int>(getpid());
  const RunDirectory directory{options.directory};
  if (auto done = write_progress(directory.progress(), progress); !done) spdlog::warn("{}", done.error().message);
  if (callbacks.on_progress) callbacks.on_progress(progress);
}

RunOutcome fail(const RunOptions& options, const RunCallbacks& callbacks, const Error& error) {
  report_end(options, callbacks, "failed", error.message);
  return failure(error);
}

/// A directory of another scene is refused, never overwritten. One whose run is to go on longer, or less long, than it
/// was gets the scene.json that says so, unless it has ended.
Result<void> claim(const scene::RunPlan& plan, const RunDirectory& directory, bool is_own_scene, bool has_ended) {
  if (!SHAKEN_TRY(file_exists(directory.scene()))) return write_file_atomically(directory.scene(), scene_text(plan));
  const Result<scene::RunPlan> present = is_own_scene ? Result<scene::RunPlan>(plan) : read_plan(directory);
  if (!present && may_pass(present.error())) return present.error();
  if (!present) {
    return Error{directory.root.string() + " holds a run whose scene cannot be read:\n" + present.error().message};
  }
  if (is_of_frames(directory)) {
    return Error{directory.root.string() + " holds what was measured on recorded frames; choose another one"};
  }
  if (scene::run_id(*present) != scene::run_id(plan)) {
    return Error{directory.root.string() + " holds the run of another scene (see its scene.json); choose another one"};
  }
  if (has_ended || (present->measure_time == plan.measure_time && present->until == plan.until)) return {};
  return write_file_atomically(directory.scene(), scene_text(plan));
}

/// Draws the movie of a run that is done, with what progress.json then says.
RunOutcome draw(const scene::RunPlan& plan, const RunOptions& options, const RunCallbacks& callbacks,
                Progress progress) {
  const RunDirectory directory{options.directory};
  const auto report = [&](const std::string& state, const std::string& message) {
    progress.state = state;
    progress.message = message;
    if (state != "rendering") progress.eta = 0;
    if (auto done = write_progress(directory.progress(), progress); !done) spdlog::warn("{}", done.error().message);
    if (callbacks.on_progress) callbacks.on_progress(progress);
  };
  const Result<bool> has_movie = file_exists(directory.movie());
  if (plan.movie && callbacks.make_movie && !(has_movie && *has_movie)) {
    const auto on_drawn = [&](double drawn, double eta) {
      progress.drawn = drawn;
      progress.eta = eta;
      report("rendering", "");
    };
    on_drawn(0, -1);
    if (auto done = callbacks.make_movie(on_drawn); !done) {
      if (options.stop != nullptr && *options.stop) {
        report("stopped", "asked to stop");
        return {RunState::kStopped, ""};
      }
      const std::string message =
          "the run is done, but without its movie, which the next start draws: " + done.error().message;
      report("failed", message);
      return {RunState::kFailed, message};
    }
  }
  report("done", "");
  return {RunState::kDone, ""};
}

RunOutcome run_owned(const scene::RunPlan& plan, const RunOptions& options, const RunCallbacks& callbacks) {
  const RunDirectory directory{options.directory};
  const bool has_ended = is_done(directory, plan);
  if (auto done = claim(plan, directory, options.is_own_scene, has_ended); !done) return failure(done.error());
  if (has_ended) {
    spdlog::info("{} is done already", directory.root.string());
    drop_logged_frames(directory);  // left by a worker that was killed right after its last word
    const Result<Progress> last = read_progress(directory.progress());
    return draw(plan, options, callbacks, last ? *last : Progress{});
  }
  Progress last;
  {
    const GoOn go_on = [&options] { return options.stop == nullptr || !*options.stop; };
    Result<Opened> opened = open_run(plan, directory, go_on);
    if (!opened && begins_with_compression(plan) && !go_on()) {  // nothing is there to be saved
      report_end(options, callbacks, "stopped", "asked to stop");
      return {RunState::kStopped, ""};
    }
    if (!opened) return fail(options, callbacks, opened.error());
    if (options.n_threads > 1) {
      opened->run.simulation.use_threads(options.n_threads);
      opened->run.simulation.share_where_faster(wall_seconds);
    }
    const bool fresh = opened->fresh;
    Loop loop(plan, options, callbacks, std::move(opened->run));
    loop.report("running");
    RunOutcome outcome = loop.run(fresh);
    if (outcome.state != RunState::kDone) return outcome;
    last = loop.progress();
  }
  return draw(plan, options, callbacks, last);
}

}  // namespace

RunOutcome run(const scene::RunPlan& plan, const RunOptions& options, const RunCallbacks& callbacks) {
  std::error_code reason;
  std::filesystem::create_directories(options.directory, reason);
  if (reason) return failure({"cannot create " + options.directory.string() + ": " + reason.message(), reason.value()});
  const Result<DirectoryLock> lock = DirectoryLock::acquire(RunDirectory{options.directory}.lock());
  if (!lock) return failure(lock.error());
  const RunDirectory own{options.directory};
  for (const auto& file : {own.scene(), own.trajectory(), own.frames(), own.observables(), own.summary(),
                           own.progress(), own.checkpoint(), own.trouble()})
    remove_unfinished(file);  // of workers that were killed
  if (callbacks.on_owned) callbacks.on_owned();
  try {
    return run_owned(plan, options, callbacks);
  } catch (const std::bad_alloc&) {
    return fail(options, callbacks, {"there is no memory left", ENOMEM});
  } catch (const std::system_error& problem) {  // no thread, say
    return fail(options, callbacks, {problem.what(), problem.code().value()});
  } catch (const std::exception& problem) {
    return fail(options, callbacks, {std::string("internal error: ") + problem.what()});
  }
}

}  // namespace shaken::run
