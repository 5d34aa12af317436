// SPDX-License-Identifier: MIT
#include "run/probe/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/clock.h"
#include "proto/frame_codec.h"
#include "run/messages.h"
#include "run/movie_process.h"
#include "run/probe/impulse_cost.h"
#include "run/probe/sampling.h"
#include "run/probe/scratch_folder.h"
#include "run/session.h"
#include "scene/canonical.h"

namespace shaken::run {
namespace {

constexpr double kCpu = 0.02;   ///< for timing one kind of work, about [s]
constexpr int kSnapshots = 8;   ///< states that measurements are tried on
constexpr int kFrames = 8;      ///< recorded to see what a frame costs
constexpr int kShortMovie = 4;  ///< frames of the shorter of two movies; the longer has three times as many
constexpr double kCheckpointEvery =
    30;  ///< the worker's default; wall-clock time, which is CPU time if it runs alone [s]
constexpr Tick kMostSnapshots = 100'000;  ///< counted one by one

double bytes_in(const std::filesystem::path& file) { return static_cast<double>(std::filesystem::file_size(file)); }

class Prober {
 public:
  Prober(const scene::RunPlan& plan, Simulation simulation, double cpu)
      : plan_(plan), simulation_(std::move(simulation)), cpu_(cpu), dt_(plan.system.dt) {}

  Result<Probe> run() {
    result_.run_ticks = static_cast<double>(total_ticks(plan_));
    if (auto error = step()) return *error;
    time_impulse_laws();
    const SamplingCost sampling = time_sampling(plan_, simulation_.world().species.front(), snapshots_);
    result_.samples = sampling.samples;
    result_.disk.observables = sampling.file_bytes;
    result_.snapshots = {snapshots_in_run(), time_of([&] { snapshots_.back() = simulation_.snapshot(); }, kCpu, 2), 0};
    if (auto error = time_recording()) return *error;
    if (plan_.movie) time_movie();
    if (auto error = time_checkpoints(sampling.state_bytes)) return *error;
    if (plan_.stream) time_stream();
    return result_;
  }

 private:
  struct Stretch {
    Tick ticks = 0;
    double cpu = 0;  ///< [s]
  };

  /// Steps for about `cpu` seconds: whole vibrations, if it is at least one, as speed changes with the plates' phase.
  Result<Stretch> step_for(double cpu, PhaseTimes::Clock clock) {
    const auto period = static_cast<Tick>(std::max(1.0, std::round(1.0 / (plan_.system.frequency * dt_))));
    Stretch stretch;
    Tick stride = std::max<Tick>(1, period / 64);
    const double begin = clock();
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
      stretch.cpu = clock() - begin;
    }
    return stretch;
  }

  [[nodiscard]] std::optional<Error> step() {
    // From a checkpoint too: lists and schedules have to be built.
    const auto warm_up = step_for(simulation_.tick() == 0 ? cpu_ / 2 : cpu_ / 16, thread_cpu_seconds);
    if (!warm_up) return warm_up.error();
    result_.warm_up = static_cast<double>(warm_up->ticks) * dt_;

    const Counters before = simulation_.world().counters;
    const auto timed = step_for(0.375 * cpu_, thread_cpu_seconds);
    if (!timed) return timed.error();
    const Counters after = simulation_.world().counters;
    result_.simulated = static_cast<double>(timed->ticks) * dt_;
    result_.cpu = timed->cpu;
    result_.tick_cpu = timed->cpu / static_cast<double>(timed->ticks);
    const double runs = result_.run_ticks / static_cast<double>(timed->ticks);
    rod_rod_ = runs * static_cast<double>(after.impulses_rod_rod - before.impulses_rod_rod);
    rod_base_ = runs * static_cast<double>(after.impulses_rod_base - before.impulses_rod_base);
    rod_lid_ = runs * static_cast<double>(after.impulses_rod_lid - before.impulses_rod_lid);
    rod_wall_ = runs * static_cast<double>(after.impulses_rod_wall - before.impulses_rod_wall);

    // reading the clock costs time, so the stages come from a stretch of their own
    simulation_.time_phases(thread_cpu_seconds_without_readings);
    const auto phased = step_for(cpu_ / 8, thread_cpu_seconds_without_readings);
    if (!phased) return phased.error();
    for (std::size_t p = 0; p < kPhases; ++p) {
      result_.stages[p] = std::max(0.0, simulation_.phase_times().seconds(static_cast<Phase>(p)) / phased->cpu);
    }
    // small errors of the clock must not make more than the whole
    const double sum = std::accumulate(result_.stages.begin(), result_.stages.end(), 0.0);
    if (sum > 1) {
      for (double& share : result_.stages) share /= sum;
    }
    simulation_.time_phases(nullptr);
    for (int k = 0; k < kSnapshots; ++k) {
      const auto between = step_for(cpu_ / 8 / kSnapshots, thread_cpu_seconds);
      if (!between) return between.error();
      snapshots_.push_back(simulation_.snapshot());
    }
    return std::nullopt;
  }

  /// What friction and bounce add to an impulse, times the impulses of the run. Made-up hits can be harder to compute
  /// than those that occur, so no part is allowed more than its stage.
  void time_impulse_laws() {
    const auto add = [&](const std::string& kind, const ContactParameters& contact, Against what, double impulses) {
      if (impulses == 0 || (contact.friction == 0 && contact.restitution == 0)) return;
      const ImpulseCost cost = time_impulses(simulation_.world(), contact, what);
      const Phase phase = kind == "rod_rod" ? Phase::kResponse : Phase::kPlates;
      const double stage = result_.stages[static_cast<std::size_t>(phase)] * result_.stepping();
      const auto put = [&](const char* part, double each) {
        result_.impulse_cpu[kind + part] = std::min(stage, impulses * each);
      };
      if (contact.friction > 0) put("_friction", cost.friction);
      if (contact.restitution > 0) put("_restitution", cost.restitution);
    };
    add("rod_rod", plan_.system.rod_rod, Against::kRod, rod_rod_);
    add("rod_base", plan_.system.rod_base, Against::kPlate, rod_base_);
    add("rod_lid", plan_.system.rod_lid, Against::kPlate, rod_lid_);
    if (plan_.system.walls) add("side_wall", plan_.system.walls->contact, Against::kRod, rod_wall_);
  }

  /// Ticks of the run at which anything is sampled or recorded.
  std::int64_t snapshots_in_run() const {
    const Measurements measurements(plan_, simulation_.world().species.front());
    const std::optional<Cadence> recording = recording_of(plan_);
    const Tick end = total_ticks(plan_);
    std::int64_t n = 0;
    for (Tick tick = 0;; ++tick) {
      tick = std::min(measurements.next_due(tick), recording ? recording->next(tick) : kNever);
      if (tick > end) return n;
      if (++n == kMostSnapshots) {
        return std::llround(static_cast<double>(n) * static_cast<double>(end) / static_cast<double>(tick));
      }
    }
  }

  /// Records `n` frames of the present state, `cadence` apart, into DIR/trajectory.h5. Returns the CPU time of one, or
  /// why they cannot be written.
  Result<double> record(const std::filesystem::path& folder, const Cadence& cadence, int n) {
    auto writer = TrajectoryWriter::create(
        folder / "trajectory.h5", trajectory_header(simulation_.world(), scene::to_json(plan_).dump(2) + "\n"));
    if (!writer) return writer.error();
    Snapshot frame = snapshots_.back();
    const double begin = thread_cpu_seconds();
    for (int k = 0; k < n; ++k) {
      frame.tick = k * cadence.period();
      frame.time = static_cast<double>(frame.tick) * dt_;
      if (auto error = writer->append(frame)) return *error;
    }
    return (thread_cpu_seconds() - begin) / n;
  }

  [[nodiscard]] std::optional<Error> time_recording() {
    const std::optional<Cadence> recording = recording_of(plan_);
    if (!recording) return std::nullopt;
    result_.trajectory.count = total_ticks(plan_) / recording->period() + 1;
    double bytes[2] = {0, 0};
    for (const int n : {1, 1 + kFrames}) {
      const ScratchFolder folder;
      const auto cpu = record(folder.path(), *recording, n);
      if (!cpu) return cpu.error();
      result_.trajectory.each = *cpu;
      bytes[n > 1] = bytes_in(folder.path() / "trajectory.h5");
    }
    const double frame = (bytes[1] - bytes[0]) / kFrames;
    result_.disk.trajectory = bytes[0] + frame * static_cast<double>(result_.trajectory.count - 1);
    return std::nullopt;
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
      auto error = recorded ? render_movie(folder.path(), stop) : std::optional(recorded.error());
      if (error) {
        result_.movie_trouble = error->message;
        return;
      }
      cpu[n > kShortMovie] = children_cpu_seconds() - before;
    }
    result_.movie.count = total_ticks(plan_) / cadence.period() + 1;
    result_.movie.each = std::max(0.0, (cpu[1] - cpu[0]) / (2 * kShortMovie));
    result_.movie.once = std::max(0.0, cpu[0] - kShortMovie * result_.movie.each);
  }

  [[nodiscard]] std::optional<Error> time_checkpoints(double measurement_bytes) {
    const ScratchFolder folder;
    const RunDirectory directory{folder.path()};
    const double begin = thread_cpu_seconds();
    const Checkpoint checkpoint{simulation_.checkpoint(),
                                std::vector<std::byte>(static_cast<std::size_t>(measurement_bytes)), 0, 0};
    if (auto error = write_checkpoint(directory, scene::run_id(plan_), checkpoint)) return error;
    result_.checkpoints.each = thread_cpu_seconds() - begin;
    // one at the end, and one now and then before
    result_.checkpoints.count = 1 + static_cast<std::int64_t>(result_.total() / kCheckpointEvery);
    result_.disk.checkpoints =
        bytes_in(directory.checkpoint()) * std::min<double>(2, static_cast<double>(result_.checkpoints.count));
    return std::nullopt;
  }

  /// Frames are sent by the clock on the wall, which is CPU time if the run has a core to itself.
  void time_stream() {
    const double each = time_of([&] { proto::encode_frame(make_frame(simulation_.snapshot())); }, kCpu, 2);
    const double rate = plan_.stream->rate;
    const double run = result_.total() - result_.movie.cpu();
    const double frames = run * rate / std::max(0.01, 1 - rate * each);  // the frames take time too
    const double most = result_.trajectory.count > 0 ? static_cast<double>(result_.trajectory.count) : frames;
    result_.stream = {std::llround(std::min(frames, most)), each, 0};
  }

  const scene::RunPlan& plan_;
  Simulation simulation_;
  double cpu_;
  double dt_;
  Probe result_;
  std::vector<Snapshot> snapshots_;
  double rod_rod_ = 0, rod_base_ = 0, rod_lid_ = 0, rod_wall_ = 0;  ///< impulses of the whole run
};

}  // namespace

double Probe::total() const {
  double sum = stepping() + snapshots.cpu() + trajectory.cpu() + stream.cpu() + checkpoints.cpu() + movie.cpu();
  for (const auto& [effect, cost] : samples) sum += cost.cpu();
  return sum;
}

Result<Probe> probe(const scene::RunPlan& plan, Simulation simulation, double cpu) {
  return Prober(plan, std::move(simulation), cpu).run();
}

}  // namespace shaken::run
