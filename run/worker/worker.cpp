#include <malloc.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/failure.h"
#include "base/files.h"
#include "base/process.h"
#include "base/program.h"
#include "base/progress_line.h"
#include "base/terminal.h"
#include "base/text.h"
#include "proto/bus.h"
#include "run/cost/run_cost.h"
#include "run/files/foreign_file.h"
#include "run/files/version.h"
#include "run/import/import_run.h"
#include "run/loop/loop.h"
#include "run/loop/movie_process.h"
#include "run/loop/replay.h"
#include "run/loop/saved_run.h"
#include "run/loop/start_state.h"
#include "run/loop/words_of_run.h"
#include "run/recorded/measure_command.h"
#include "scene/canonical.h"
#include "scene/load.h"
#include "scene/memory_limit.h"
#include "scene/placement.h"

namespace shaken::run {
namespace {

constexpr const char* kFooter = R"(Examples:
  shaken-worker quickstart.json --out runs/quick
  shaken-worker quickstart.json --out runs/long -s time.measure="60 s" -s time.seed=7 --no-lcm
  shaken-worker quickstart.json --out runs/quick      goes on from the last checkpoint, or says that it is done
  shaken-worker quickstart.json --probe cost.json     runs nothing, but tells what the run would cost
  shaken-worker replay runs/wild                      meets a failed run's numerical trouble again
  shaken-worker import rods.csv --scene scene.json    makes a run of the rods in a file
  shaken-worker measure runs/first --out wide         measures the frames of a run anew

Exit codes: 0 done, 1 failed, 2 bad input, 97 no room on the disk,
98 an error of the system that may pass, 99 stopped by a signal after a checkpoint.)";

/// What the command line of shaken-worker asks for.
struct WorkerOptions {
  std::string scene;
  std::vector<std::string> settings;
  std::string out;
  std::string job_id;
  std::string sweep_id;
  std::string label;
  std::string lcm_url = proto::default_url();
  bool no_lcm = false;
  int n_threads = 1;
  double checkpoint_every = kCheckpointEvery.count();
  bool quiet = false;
  std::string probe;
  double probe_cpu = 1.0;
  std::string probe_from;
};

constexpr double kProgressPeriod = 5;  ///< between two lines of progress in a log [s]

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

void request_stop(int) { stop_requested = true; }

/// Whether stderr already goes to `file`, as it does under the daemon.
bool stderr_goes_to(const std::filesystem::path& file) {
  struct stat error_output {};
  struct stat log {};
  return fstat(STDERR_FILENO, &error_output) == 0 && stat(file.c_str(), &log) == 0 &&
         error_output.st_dev == log.st_dev && error_output.st_ino == log.st_ino;
}

void log_to_stderr(bool quiet) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  if (quiet) sink->set_level(spdlog::level::warn);
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("shaken-worker", std::move(sink)));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %v");
  spdlog::flush_on(spdlog::level::info);
}

void log_to_file_too(const std::filesystem::path& file) {
  if (stderr_goes_to(file)) return;
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
    sink->set_pattern("%Y-%m-%dT%H:%M:%S.%e %l %v");
    spdlog::default_logger()->sinks().push_back(std::move(sink));
  } catch (const spdlog::spdlog_ex& problem) {
    spdlog::warn("no log file: {}", problem.what());
  }
}

/// What came out, on stdout; nothing where the summary cannot be read, which has been told then.
void tell_ending(const RunDirectory& directory) {
  const Result<std::string> text = read_file(directory.summary());
  if (!text) return;
  const auto summary = nlohmann::json::parse(*text, nullptr, false);
  if (!summary.is_object()) return;
  const std::string ending = describe_ending(summary, directory.root);
  if (stderr_goes_to(directory.log())) {  // a run that is done does not fail for a line that its log has no room for
    [[maybe_unused]] const ssize_t written = write(STDOUT_FILENO, ending.data(), ending.size());
    return;
  }
  std::fwrite(ending.data(), 1, ending.size(), stdout);
}

ExitCode run_scene(const scene::RunPlan& plan, const WorkerOptions& asked) {
  const RunDirectory directory{asked.out};
  std::error_code hidden;
  if (std::filesystem::exists(directory.imported(), hidden)) {
    throw Failure(ExitCode::kBadInput, asked.out + " holds imported rods, from which runs start: give another --out");
  }
  RunOptions options;
  options.directory = asked.out;
  options.is_own_scene = asked.settings.empty() && std::filesystem::equivalent(asked.scene, directory.scene(), hidden);
  options.job_id = asked.job_id.empty() ? scene::run_id(plan) : asked.job_id;
  options.label = asked.label;
  if (!asked.no_lcm) options.lcm_url = asked.lcm_url;
  options.n_threads = asked.n_threads;
  options.checkpoint_every = WallSeconds(asked.checkpoint_every);
  options.stop = &stop_requested;

  std::optional<ProgressLine> line;
  if (!asked.quiet) {
    const auto size = terminal_size(STDERR_FILENO);
    line.emplace(std::cerr, isatty(STDERR_FILENO) == 1, size ? size->columns : 0, kProgressPeriod);
  }
  RunCallbacks callbacks;
  callbacks.on_owned = [&] {
    log_to_file_too(directory.log());
    spdlog::info("run {}{}: {} rods, {} s, in {}", scene::run_id(plan),
                 asked.sweep_id.empty() ? "" : " of sweep " + asked.sweep_id, plan.system.n_all_rods(),
                 plan.total_time(), asked.out);
  };
  callbacks.on_progress = [&](const Progress& progress) {
    if (!line) return;
    const std::string text = describe_progress(progress);
    is_under_way(progress) ? line->show(text) : line->end_with(text);
  };
  callbacks.make_movie = [&](const OnDrawn& on_drawn) {
    return render_movie(asked.out, stop_requested, asked.label, on_drawn);
  };

  const RunOutcome outcome = run(plan, options, callbacks);
  switch (outcome.state) {
    case RunState::kDone:
      spdlog::info("done");
      try {
        if (!asked.quiet) tell_ending(directory);
      } catch (const std::exception& problem) {  // the run is done, whatever becomes of these words
        spdlog::warn("{}", problem.what());
      }
      return ExitCode::kOk;
    case RunState::kStopped:
      spdlog::info("stopped; start again to go on");
      return ExitCode::kStopped;
    case RunState::kNoRoom:
    case RunState::kSystemFailed:
    case RunState::kFailed:
      break;
  }
  spdlog::error("{}", outcome.message);
  if (outcome.state == RunState::kNoRoom) return ExitCode::kNoRoom;
  return outcome.state == RunState::kSystemFailed ? ExitCode::kSystemFailed : ExitCode::kFailed;
}

/// A simulation of `system` from the state that the run in `folder` was last saved in.
Result<Simulation> resume_from(const std::filesystem::path& folder, const System& system) {
  const RunDirectory directory{folder};
  return resume_last(directory, scene::run_id(SHAKEN_TRY(read_plan(directory))), system);
}

void probe_scene(const scene::RunPlan& plan, const WorkerOptions& asked) {
  std::optional<RunCost> cost;
  if (asked.probe_cpu > 0) {
    Simulation simulation = value_or_fail(
        asked.probe_from.empty() ? start_simulation(plan, "") : resume_from(asked.probe_from, plan.system),
        ExitCode::kBadInput);
    cost = value_or_fail(cost_of_run(plan, std::move(simulation), asked.probe_cpu));
    if (!cost->movie_trouble.empty()) spdlog::warn("the movie could not be timed: {}", cost->movie_trouble);
  }
  done_or_fail(write_file(asked.probe, cost_report(plan, cost).dump(2) + "\n"));
}

/// From now on SIGTERM, SIGINT and SIGHUP let the run end with a checkpoint.
void stop_on_signals() {
  std::signal(SIGTERM, request_stop);
  std::signal(SIGINT, request_stop);
  // a terminal that is closed; nohup asks to outlive it
  if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

ExitCode run_or_probe(const WorkerOptions& asked) {
  log_to_stderr(asked.quiet);
  if (asked.out.empty() == asked.probe.empty()) {
    throw Failure(ExitCode::kBadInput, "one of --out and --probe is needed (see `shaken-worker --help`)");
  }
  // A pipe may never say anything: then a signal ends the worker, which has begun nothing.
  std::error_code unknown;
  const bool may_wait = !std::filesystem::is_regular_file(asked.scene, unknown);
  const auto on_stop = may_wait ? std::signal(SIGTERM, SIG_DFL) : SIG_DFL,
             on_interrupt = may_wait ? std::signal(SIGINT, SIG_DFL) : SIG_DFL;
  const Result<std::string> read = read_input(asked.scene);
  const std::string text =
      value_or_fail(read, read || !may_pass(read.error()) ? ExitCode::kBadInput : ExitCode::kSystemFailed);
  if (may_wait) {
    std::signal(SIGTERM, on_stop);
    std::signal(SIGINT, on_interrupt);
  }
  const keys::Loaded<scene::RunPlan> plan = scene::load_scene(text, asked.scene, asked.settings);
  if (!plan) throw Failure(ExitCode::kBadInput, to_string(plan.error()));
  if (const auto problem = scene::memory_problem(*plan, scene::memory_allowed(), asked.scene)) {
    throw Failure(ExitCode::kBadInput, to_string(*problem));
  }
  if (const auto problem = scene::placement_problem(*plan, asked.scene)) {
    throw Failure(ExitCode::kBadInput, to_string(*problem));
  }
  if (asked.probe.empty()) return run_scene(*plan, asked);
  std::signal(SIGTERM, SIG_DFL);  // nothing is lost
  std::signal(SIGINT, SIG_DFL);
  probe_scene(*plan, asked);
  return ExitCode::kOk;
}

/// Does the run that is asked for, or its probe, until it has ended or a signal has stopped it. Throws Failure, with
/// every problem of the scene.
ExitCode work(const WorkerOptions& asked) {
  try {
    return run_or_probe(asked);
  } catch (const std::system_error& problem) {
    const bool passes = may_pass({problem.what(), problem.code().value()});
    throw Failure(passes ? ExitCode::kSystemFailed : ExitCode::kFailed, problem.what());
  }
}

void describe(CLI::App& app, WorkerOptions& options) {
  app.set_version_flag("--version", version());
  app.add_option("SCENE", options.scene, "Scene file (JSON)")->required();
  app.add_option("--out", options.out, "Run directory; made if it is not there")->type_name("DIR");
  app.add_option("-s,--set", options.settings, "Change one value of the scene")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("--job-id", options.job_id, "Name in live messages; the run's hash if not given")->type_name("ID");
  app.add_option("--sweep-id", options.sweep_id, "Sweep that the job belongs to, for the log")->type_name("ID");
  app.add_option("--label", options.label, "Swept parameters, shown by viewers")->type_name("TEXT");
  app.add_option("--lcm-url", options.lcm_url, "Where live state goes")->type_name("URL")->capture_default_str();
  app.add_flag("--no-lcm", options.no_lcm, "Send no live state");
  app.add_option("--threads", options.n_threads,
                 "Threads that share each tick: worth it from about 2,000 rods on. The results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--checkpoint-every", options.checkpoint_every, "Wall-clock seconds between checkpoints")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--quiet", options.quiet, "Show warnings and errors only");
  CLI::Option* probe = app.add_option("--probe", options.probe,
                                      "Instead: step a piece of the run, and write what all of it would cost as JSON");
  probe->type_name("FILE");
  app.add_option("--probe-cpu", options.probe_cpu, "CPU time of the steps, about; 0 tells only what is on and off")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 3600.0))
      ->needs(probe)
      ->capture_default_str();
  app.add_option("--probe-from", options.probe_from, "Directory of a run of the same system, to start from its state")
      ->type_name("DIR")
      ->needs(probe);
}

}  // namespace
}  // namespace shaken::run

int main(int argc, char** argv) {
  using namespace shaken;
  go_on_as_wide_build(argv);
  // A frame's buffers come and go. Given back to the system each time, they cost a short run half of its CPU time. With
  // a threshold for the heap's end that for blocks of their own is 128 kB for ever, unless it is said, too.
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  if (argc > 1 && std::string_view(argv[1]) == "replay") return run::replay_command(argc - 1, argv + 1);
  if (argc > 1 && std::string_view(argv[1]) == "read") return run::read_command(argc - 1, argv + 1);
  if (argc > 1 && std::string_view(argv[1]) == "import") return run::import_command(argc - 1, argv + 1);
  if (argc > 1 && std::string_view(argv[1]) == "measure") return run::measure_command(argc - 1, argv + 1);
  Program app("shaken-worker", "Runs one scene from start to end in a run directory.", run::kFooter);
  run::stop_on_signals();
  run::WorkerOptions options;
  describe(app, options);
  return app.run(argc, argv, [&] { return run::work(options); });
}
