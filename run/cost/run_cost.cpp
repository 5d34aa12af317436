#include "run/cost/run_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "base/memory.h"
#include "base/scratch_folder.h"
#include "proto/frame_codec.h"
#include "run/live/messages.h"
#include "run/loop/effects.h"
#include "run/loop/loop.h"
#include "run/loop/movie_process.h"
#include "run/loop/open_run.h"
#include "scene/canonical.h"
#include "scene/keys/observables.h"
#include "scene/length.h"

namespace shaken::run {
namespace {

constexpr double kCpu = 0.02;    ///< for timing one kind of work, at most about [s]
constexpr double kPart = 0.04;   ///< of the run's own time, for the steps of its probe; its samples take as much
constexpr double kLeast = 0.03;  ///< for the steps of a probe: less tells little, and nobody feels it [s]
constexpr double kPilot = 2e-3;  ///< for the first steps by which that is judged, about [s]
constexpr int kFrames = 8;       ///< recorded to see what a frame costs

double bytes_in(const std::filesystem::path& file) { return static_cast<double>(std::filesystem::file_size(file)); }

class Prober {
 public:
  Prober(const scene::RunPlan& plan, Simulation simulation, double cpu)
      : plan_(plan), simulation_(std::move(simulation)), cpu_(cpu), dt_(plan.system.dt) {}

  Result<RunCost> run() {
    cost_.run_ticks = static_cast<double>(scene::most_ticks(plan_));
    SHAKEN_TRY(time_ticks());
    // what is sampled or recorded is read first, all rods of it
    snapshot_cpu_ = time_of([&] { snapshot_ = simulation_.snapshot(); }, each_, 2);
    time_samples();
    SHAKEN_TRY(time_frames());
    if (plan_.movie) time_movie();
    SHAKEN_TRY(time_checkpoints());
    if (plan_.stream) time_stream();
    cost_.memory = peak_memory() + (plan_.movie ? children_peak_memory() : 0) + scene::peak_of(measured_);
    return cost_;
  }

 private:
  struct Stretch {
    Tick ticks = 0;
    double cpu = 0;  ///< [s]
  };

  /// Steps for about `cpu` seconds: whole vibrations, if it is at least one, as speed changes with the plates' phase.
  Result<Stretch> step_for(double cpu) {
    const auto period = static_cast<Tick>(std::max(1.0, std::round(1.0 / (plan_.system.frequency * dt_))));
    const Tick stride = std::max<Tick>(1, period / 64);
    Stretch stretch;
    const double begin = thread_cpu_seconds();
    while (stretch.cpu < cpu || (stretch.ticks > period && stretch.ticks % period != 0)) {
      const Tick ticks = std::min(stride, period - stretch.ticks % period);
      if (const auto trouble = simulation_.advance_to(simulation_.tick() + ticks)) {
        return Error{fmt::format("numerical trouble at tick {}, rods {}: {}", trouble->tick,
                                 fmt::join(trouble->rods, ", "), trouble->what)};
      }
      stretch.ticks += ticks;
      stretch.cpu = thread_cpu_seconds() - begin;
    }
    return stretch;
  }

  Result<void> time_ticks() {
    // Lists and schedules have to be built, and rods in rows are quick; so what the run will take is judged anew after
    // each stretch, twice as long as those before.
    const double part = simulation_.tick() == 0 ? 0.5 : 1.0 / 16;
    const double most = cpu_;
    Stretch warm_up;
    do {
      const auto stretch = SHAKEN_TRY(step_for(std::max(kPilot, warm_up.cpu)));
      warm_up.ticks += stretch.ticks;
      warm_up.cpu += stretch.cpu;
      cpu_ = kPart * stretch.cpu / static_cast<double>(stretch.ticks) * cost_.run_ticks;
      cpu_ = std::clamp(cpu_, std::min(kLeast, most), most);
    } while (warm_up.cpu < part * cpu_);
    each_ = std::min(kCpu, cpu_ / 16);
    const auto timed = SHAKEN_TRY(step_for(cpu_ / 2));
    cost_.warm_up = static_cast<double>(warm_up.ticks) * dt_;
    cost_.simulated = static_cast<double>(timed.ticks) * dt_;
    cost_.cpu = timed.cpu;
    cost_.tick_cpu = timed.cpu / static_cast<double>(timed.ticks);
    return {};
  }

  /// Times each measurement by itself, as if the rods stood still.
  void time_samples() {
    Observables arrays;
    for (const MeasurementKind& kind : measurement_kinds()) {
      const std::optional<Cadence> cadence = kind.cadence(plan_);
      if (!cadence) continue;
      Measurements measurements(only(plan_, kind));
      Snapshot due = snapshot_;
      Tick taken = 0;
      const auto sample = [&] {
        due.tick = cadence->next(taken++ * cadence->period());
        due.time = static_cast<double>(due.tick) * dt_;
        measurements.sample(due);
      };
      sample();
      sample();
      arrays.merge(measurements.reduce(due.time).arrays);
      cost_.parts["measure_" + std::string(kind.name)] = {cadence->count(scene::most_ticks(plan_)),
                                                          time_of(sample, each_, 2) + snapshot_cpu_, 0};
    }
    // the file of the first samples, and what grows with their number
    const ScratchFolder folder;
    if (write_observables(folder / "observables.h5", arrays)) {
      cost_.disk.observables = bytes_in(folder / "observables.h5");
    }
    for (const auto& [name, one] : measured_) cost_.disk.observables += one.file;
  }

  /// Records `n` frames of the present state, `cadence` apart, as a run does, into DIR/trajectory.h5. Returns the CPU
  /// time of one, or why they cannot be written.
  Result<double> record(const std::filesystem::path& folder, const Cadence& cadence, int n) {
    const RunDirectory directory{folder};
    auto log = SHAKEN_TRY(FrameLog::create(
        directory.frames(), trajectory_header(simulation_.world(), scene::to_json(plan_).dump(2) + "\n", {})));
    Snapshot frame = snapshot_;
    const double begin = thread_cpu_seconds();
    for (int k = 0; k < n; ++k) {
      frame.tick = k * cadence.period();
      frame.time = static_cast<double>(frame.tick) * dt_;
      SHAKEN_TRY(log.append(shaken::run::record(frame)));
    }
    const TrajectoryReader frames = SHAKEN_TRY(TrajectoryReader::open(directory.frames()));
    SHAKEN_TRY(write_trajectory(directory.trajectory(), frames.recorded()));
    std::filesystem::remove(directory.frames());
    return (thread_cpu_seconds() - begin) / n;
  }

  Result<void> time_frames() {
    const std::optional<Cadence> recording = recording_of(plan_);
    if (!recording) return {};
    Cost& frames = cost_.parts["trajectory"];
    frames.count = scene::most_ticks(plan_) / recording->period() + 1;
    double bytes[2] = {0, 0};
    for (const int n : {1, 1 + kFrames}) {
      const ScratchFolder folder;
      frames.each = SHAKEN_TRY(record(folder.path(), *recording, n)) + snapshot_cpu_;
      bytes[n > 1] = bytes_in(folder / "trajectory.h5");
    }
    const auto n = static_cast<double>(frames.count);
    cost_.disk.trajectory = bytes[0] + (bytes[1] - bytes[0]) / kFrames * (n - 1);
    cost_.disk.trajectory_part = n * static_cast<double>(frame_bytes(snapshot_.n_rods()));
    return {};
  }

  /// Draws two movies, of one and of three frames; they differ by the cost of two.
  void time_movie() {
    const Cadence cadence(plan_.movie->every, dt_);
    double cpu[2] = {0, 0};
    for (const int n : {1, 3}) {
      const ScratchFolder folder;
      const auto recorded = record(folder.path(), cadence, n);
      const double before = children_cpu_seconds();
      const std::atomic<bool> stop = false;
      const Result<void> drawn = recorded ? render_movie(folder.path(), stop) : recorded.error();
      if (!drawn) {
        cost_.movie_trouble = drawn.error().message;
        return;
      }
      cpu[n > 1] = children_cpu_seconds() - before;
    }
    const double each = std::max(0.0, (cpu[1] - cpu[0]) / 2);
    cost_.parts["movie"] = {scene::most_ticks(plan_) / cadence.period() + 1, each, std::max(0.0, cpu[0] - each)};
  }

  Result<void> time_checkpoints() {
    double state = 0;
    for (const auto& [name, one] : measured_) state += one.state;
    const ScratchFolder folder;
    const RunDirectory directory{folder.path()};
    const double begin = thread_cpu_seconds();
    const Checkpoint checkpoint{simulation_.checkpoint(), std::vector<std::byte>(static_cast<std::size_t>(state)), 0,
                                0};
    SHAKEN_TRY(write_checkpoint(directory, scene::run_id(plan_), checkpoint));
    cost_.checkpoints.each = thread_cpu_seconds() - begin;
    // one at the end, and one now and then before
    cost_.checkpoints.count = 1 + static_cast<std::int64_t>(cost_.total() / kCheckpointEvery.count());
    cost_.disk.checkpoints =
        bytes_in(directory.checkpoint()) * std::min<double>(2, static_cast<double>(cost_.checkpoints.count));
    return {};
  }

  /// Frames are sent by the clock on the wall, which is CPU time if the run has a core to itself.
  void time_stream() {
    const double each =
        time_of([&] { proto::encode_frame(make_frame(simulation_.world(), simulation_.snapshot())); }, each_, 2);
    const double rate = plan_.stream->rate;
    const double run = cost_.total() - cost_.cpu_of("movie").value_or(0);
    double frames = run * rate / std::max(0.01, 1 - rate * each);  // the frames take time too
    if (plan_.trajectory || plan_.movie) {
      frames = std::min(frames, static_cast<double>(cost_.parts.at("trajectory").count));
    }
    cost_.parts["stream"] = {std::llround(frames), each, 0};
  }

  const scene::RunPlan& plan_;
  const std::map<std::string, scene::MeasureMemory> measured_ = scene::measure_memory(plan_);
  Simulation simulation_;
  double cpu_;       ///< for steps [s]
  double each_ = 0;  ///< for timing one kind of work [s]
  double dt_;
  RunCost cost_;
  Snapshot snapshot_;        ///< that is sampled, recorded and drawn
  double snapshot_cpu_ = 0;  ///< of reading all rods [s]
};

}  // namespace

double RunCost::total() const {
  double sum = stepping() + checkpoints.cpu();
  for (const auto& [effect, cost] : parts) sum += cost.cpu();
  return sum;
}

std::optional<double> RunCost::cpu_of(const std::string& effect) const {
  const auto found = parts.find(effect);
  return found == parts.end() ? std::nullopt : std::optional(found->second.cpu());
}

Result<RunCost> cost_of_run(const scene::RunPlan& plan, Simulation simulation, double cpu) {
  return Prober(plan, std::move(simulation), cpu).run();
}

nlohmann::ordered_json cost_report(const scene::RunPlan& plan, const std::optional<RunCost>& cost) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson report;
  const double total = cost ? cost->total() : 0;
  report["effects"] = OrderedJson::array();
  for (const EffectLine& line : list_effects(plan)) {
    OrderedJson entry{{"name", line.name}, {"what", line.what}, {"on", line.on}, {"why", line.why}};
    const auto cpu = cost && line.on ? cost->cpu_of(line.name) : std::nullopt;
    if (cpu) entry["cpu_share"] = *cpu / total;
    report["effects"].push_back(std::move(entry));
  }
  if (!cost) return report;
  report["probe"] = {{"warm_up_s", cost->warm_up},
                     {"simulated_s", cost->simulated},
                     {"cpu_s", cost->cpu},
                     {"rod_seconds_per_cpu_second", plan.system.n_all_rods() * cost->simulated / cost->cpu}};
  report["stepping_cpu_share"] = cost->stepping() / total;
  report["checkpoints_cpu_share"] = cost->checkpoints.cpu() / total;
  report["cpu_seconds"] = total;
  report["stepping_cpu_seconds"] = cost->stepping();
  report["disk_bytes"] = {{"trajectory", cost->disk.trajectory},
                          {"observables", cost->disk.observables},
                          {"checkpoints", cost->disk.checkpoints},
                          {"total", cost->disk.total()},
                          {"most", cost->disk.most()}};
  report["memory_bytes"] = cost->memory;
  return report;
}

}  // namespace shaken::run
