// SPDX-License-Identifier: MIT
#include "run/probe/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "base/clock.h"
#include "base/peak_memory.h"
#include "base/scratch_folder.h"
#include "proto/frame_codec.h"
#include "run/effects.h"
#include "run/messages.h"
#include "run/movie_process.h"
#include "run/open_run.h"
#include "scene/canonical.h"
#include "scene/length.h"

namespace shaken::run {
namespace {

constexpr double kCpu = 0.02;    ///< for timing one kind of work, at most about [s]
constexpr double kPart = 0.1;    ///< of the run's own time, that its probe may take
constexpr double kPilot = 2e-3;  ///< for the steps by which that is judged, about [s]
constexpr int kSnapshots = 8;    ///< states that measurements are tried on
constexpr int kFrames = 8;       ///< recorded to see what a frame costs
constexpr int kShortMovie = 1;   ///< frames of the shorter of two movies; the longer has three times as many
constexpr double kCheckpointEvery =
    30;  ///< the worker's default; wall-clock time, which is CPU time if it runs alone [s]

double bytes_in(const std::filesystem::path& file) { return static_cast<double>(std::filesystem::file_size(file)); }

class Prober {
 public:
  Prober(const scene::RunPlan& plan, Simulation simulation, double cpu)
      : plan_(plan), simulation_(std::move(simulation)), cpu_(cpu), each_(kCpu), dt_(plan.system.dt) {}

  Result<Probe> run() {
    result_.run_ticks = static_cast<double>(scene::total_ticks(plan_));
    if (auto done = step(); !done) return done.error();
    const SamplingCost sampling = time_sampling(plan_, snapshots_, each_);
    result_.parts = sampling.samples;
    result_.disk.observables = sampling.file_bytes;
    // what is sampled or recorded is read first, all rods of it
    snapshot_cpu_ = time_of([&] { snapshots_.back() = simulation_.snapshot(); }, each_, 2);
    for (auto& [effect, cost] : result_.parts) cost.each += snapshot_cpu_;
    if (auto done = time_recording(); !done) return done.error();
    if (plan_.movie) time_movie();
    if (auto done = time_checkpoints(sampling.state_bytes); !done) return done.error();
    if (plan_.stream) time_stream();
    result_.memory = peak_memory() + (plan_.movie ? children_peak_memory() : 0);
    return result_;
  }

 private:
  struct Stretch {
    Tick ticks = 0;
    double cpu = 0;  ///< [s]
  };

  /// Steps for about `cpu` seconds: whole vibrations, if it is at least one, as speed changes with the plates' phase.
  Result<Stretch> step_for(double cpu) {
    const auto period = static_cast<Tick>(std::max(1.0, std::round(1.0 / (plan_.system.frequency * dt_))));
    Stretch stretch;
    Tick stride = std::max<Tick>(1, period / 64);
    const double begin = thread_cpu_seconds();
    while (stretch.cpu < cpu || (stretch.ticks > period && stretch.ticks % period != 0)) {
      // doubled until it is worth a sixteenth of the time; then to the end of a vibration, if one was reached
      Tick ticks = stride;
      if (stretch.cpu < cpu / 16) {
        stride *= 2;
      } else if (stretch.cpu >= cpu) {
        ticks = period - stretch.ticks % period;
      }
      if (const auto trouble = simulation_.advance_to(simulation_.tick() + ticks)) {
        return Error{fmt::format("numerical trouble at tick {}, rods {}: {}", trouble->tick,
                                 fmt::join(trouble->rods, ", "), trouble->what)};
      }
      stretch.ticks += ticks;
      stretch.cpu = thread_cpu_seconds() - begin;
    }
    return stretch;
  }

  Result<void> step() {
    const auto pilot = step_for(kPilot);
    if (!pilot) return pilot.error();
    cpu_ = std::min(cpu_, std::max(kPilot, kPart * pilot->cpu / static_cast<double>(pilot->ticks) * result_.run_ticks));
    each_ = std::min(kCpu, cpu_ / 8);
    // From a checkpoint too: lists and schedules have to be built.
    const auto warm_up = step_for(simulation_.tick() == 0 ? cpu_ / 2 : cpu_ / 16);
    if (!warm_up) return warm_up.error();
    result_.warm_up = static_cast<double>(warm_up->ticks) * dt_;

    const auto timed = step_for(0.5 * cpu_);
    if (!timed) return timed.error();
    result_.simulated = static_cast<double>(timed->ticks) * dt_;
    result_.cpu = timed->cpu;
    result_.tick_cpu = timed->cpu / static_cast<double>(timed->ticks);
    for (int k = 0; k < kSnapshots; ++k) {
      const auto between = step_for(cpu_ / 8 / kSnapshots);
      if (!between) return between.error();
      snapshots_.push_back(simulation_.snapshot());
    }
    return {};
  }

  /// Records `n` frames of the present state, `cadence` apart, as a run does, into DIR/trajectory.h5. Returns the CPU
  /// time of one, or why they cannot be written.
  Result<double> record(const std::filesystem::path& folder, const Cadence& cadence, int n) {
    const RunDirectory directory{folder};
    auto log = FrameLog::create(directory.frames(),
                                trajectory_header(simulation_.world(), scene::to_json(plan_).dump(2) + "\n", {}));
    if (!log) return log.error();
    Snapshot frame = snapshots_.back();
    const double begin = thread_cpu_seconds();
    for (int k = 0; k < n; ++k) {
      frame.tick = k * cadence.period();
      frame.time = static_cast<double>(frame.tick) * dt_;
      if (auto done = log->append(shaken::run::record(frame)); !done) return done.error();
    }
    const Result<TrajectoryReader> frames = TrajectoryReader::open(directory.frames());
    if (!frames) return frames.error();
    if (auto done = write_trajectory(directory.trajectory(), frames->recorded()); !done) return done.error();
    std::error_code ignored;
    part_bytes_[n > 1] = std::filesystem::file_size(directory.frames(), ignored);
    std::filesystem::remove(directory.frames(), ignored);
    return (thread_cpu_seconds() - begin) / n;
  }

  Result<void> time_recording() {
    const std::optional<Cadence> recording = recording_of(plan_);
    if (!recording) return {};
    Cost& frames = result_.parts["trajectory"];
    frames.count = scene::total_ticks(plan_) / recording->period() + 1;
    const auto later = static_cast<double>(frames.count - 1);
    double bytes[2] = {0, 0};
    for (const int n : {1, 1 + kFrames}) {
      const ScratchFolder folder;
      const auto cpu = record(folder.path(), *recording, n);
      if (!cpu) return cpu.error();
      frames.each = *cpu + snapshot_cpu_;
      bytes[n > 1] = bytes_in(folder.path() / "trajectory.h5");
    }
    const auto with = [&](double one, double more) { return one + (more - one) / kFrames * later; };
    result_.disk.trajectory_part = with(static_cast<double>(part_bytes_[0]), static_cast<double>(part_bytes_[1]));
    result_.disk.trajectory = with(bytes[0], bytes[1]);
    return {};
  }

  /// Draws two movies; they differ by the cost of the frames that one has more.
  void time_movie() {
    const Cadence cadence(plan_.movie->every, dt_);
    double cpu[2] = {0, 0};
    for (const int n : {kShortMovie, 3 * kShortMovie}) {
      const ScratchFolder folder;
      const auto recorded = record(folder.path(), cadence, n);
      const double before = children_cpu_seconds();
      const std::atomic<bool> stop = false;
      const Result<void> drawn = recorded ? render_movie(folder.path(), stop) : recorded.error();
      if (!drawn) {
        result_.movie_trouble = drawn.error().message;
        return;
      }
      cpu[n > kShortMovie] = children_cpu_seconds() - before;
    }
    const double each = std::max(0.0, (cpu[1] - cpu[0]) / (2 * kShortMovie));
    result_.parts["movie"] = {scene::total_ticks(plan_) / cadence.period() + 1, each,
                              std::max(0.0, cpu[0] - kShortMovie * each)};
  }

  Result<void> time_checkpoints(double measurement_bytes) {
    const ScratchFolder folder;
    const RunDirectory directory{folder.path()};
    const double begin = thread_cpu_seconds();
    const Checkpoint checkpoint{simulation_.checkpoint(),
                                std::vector<std::byte>(static_cast<std::size_t>(measurement_bytes)), 0, 0};
    if (auto done = write_checkpoint(directory, scene::run_id(plan_), checkpoint); !done) return done.error();
    result_.checkpoints.each = thread_cpu_seconds() - begin;
    // one at the end, and one now and then before
    result_.checkpoints.count = 1 + static_cast<std::int64_t>(result_.total() / kCheckpointEvery);
    result_.disk.checkpoints =
        bytes_in(directory.checkpoint()) * std::min<double>(2, static_cast<double>(result_.checkpoints.count));
    return {};
  }

  /// Frames are sent by the clock on the wall, which is CPU time if the run has a core to itself.
  void time_stream() {
    const double each =
        time_of([&] { proto::encode_frame(make_frame(simulation_.world(), simulation_.snapshot())); }, each_, 2);
    const double rate = plan_.stream->rate;
    const double run = result_.total() - result_.cpu_of("movie").value_or(0);
    double frames = run * rate / std::max(0.01, 1 - rate * each);  // the frames take time too
    if (plan_.trajectory || plan_.movie) {
      frames = std::min(frames, static_cast<double>(result_.parts.at("trajectory").count));
    }
    result_.parts["stream"] = {std::llround(frames), each, 0};
  }

  const scene::RunPlan& plan_;
  Simulation simulation_;
  double cpu_;   ///< for steps [s]
  double each_;  ///< for timing one kind of work [s]
  double dt_;
  Probe result_;
  std::vector<Snapshot> snapshots_;
  double snapshot_cpu_ = 0;                ///< of reading all rods [s]
  std::uintmax_t part_bytes_[2] = {0, 0};  ///< of trajectory.part with one frame, and with more
};

}  // namespace

double Probe::total() const {
  double sum = stepping() + checkpoints.cpu();
  for (const auto& [effect, cost] : parts) sum += cost.cpu();
  return sum;
}

std::optional<double> Probe::cpu_of(const std::string& effect) const {
  const auto found = parts.find(effect);
  return found == parts.end() ? std::nullopt : std::optional(found->second.cpu());
}

Result<Probe> probe(const scene::RunPlan& plan, Simulation simulation, double cpu) {
  return Prober(plan, std::move(simulation), cpu).run();
}

nlohmann::ordered_json probe_report(const scene::RunPlan& plan, const std::optional<Probe>& probe) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson report;
  const double total = probe ? probe->total() : 0;
  report["effects"] = OrderedJson::array();
  for (const EffectLine& line : list_effects(plan)) {
    OrderedJson entry{{"name", line.name}, {"what", line.what}, {"on", line.on}, {"why", line.why}};
    const auto cpu = probe && line.on ? probe->cpu_of(line.name) : std::nullopt;
    if (cpu) entry["cpu_share"] = *cpu / total;
    report["effects"].push_back(std::move(entry));
  }
  if (!probe) return report;
  report["probe"] = {{"warm_up_s", probe->warm_up},
                     {"simulated_s", probe->simulated},
                     {"cpu_s", probe->cpu},
                     {"rod_seconds_per_cpu_second", plan.system.n_all_rods() * probe->simulated / probe->cpu}};
  report["stepping_cpu_share"] = probe->stepping() / total;
  report["checkpoints_cpu_share"] = probe->checkpoints.cpu() / total;
  report["cpu_seconds"] = total;
  report["stepping_cpu_seconds"] = probe->stepping();
  report["disk_bytes"] = {{"trajectory", probe->disk.trajectory},
                          {"observables", probe->disk.observables},
                          {"checkpoints", probe->disk.checkpoints},
                          {"total", probe->disk.total()},
                          {"most", probe->disk.most()}};
  report["memory_bytes"] = probe->memory;
  return report;
}

}  // namespace shaken::run
