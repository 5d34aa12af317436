// SPDX-License-Identifier: MIT
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <iostream>
#include <optional>

#include "base/failure.h"
#include "base/files.h"
#include "base/help_formatter.h"
#include "base/progress_line.h"
#include "base/standard_streams.h"
#include "base/terminal.h"
#include "base/text.h"
#include "proto/bus.h"
#include "run/ending.h"
#include "run/files/version.h"
#include "run/loop.h"
#include "run/movie_process.h"
#include "run/probe/probe.h"
#include "run/progress_text.h"
#include "run/replay.h"
#include "run/saved_run.h"
#include "run/start_state.h"
#include "scene/canonical.h"
#include "scene/load.h"
#include "scene/memory_limit.h"
#include "scene/placement.h"

namespace {

using namespace shaken;

constexpr double kProgressPeriod = 5;  ///< between two lines of progress in a log [s]

constexpr const char* kFooter = R"(Examples:
  shaken-worker quickstart.json --out runs/quick
  shaken-worker quickstart.json --out runs/long -s time.measure="60 s" -s time.seed=7 --no-lcm
  shaken-worker quickstart.json --out runs/quick      goes on from the last checkpoint, or says that it is done
  shaken-worker quickstart.json --probe cost.json     runs nothing, but tells what the run would cost
  shaken-worker replay runs/wild                      meets a failed run's numerical trouble again

Exit codes: 0 done, 1 failed, 2 bad input, 97 no room on the disk, 99 stopped by a signal after a checkpoint.)";

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

struct Arguments {
  std::string scene;
  std::vector<std::string> settings;
  std::string out;
  std::string job_id;
  std::string sweep_id;
  std::string label;
  std::string lcm_url = proto::default_url();
  bool no_lcm = false;
  int n_threads = 1;
  double checkpoint_every = 30;
  bool quiet = false;
  std::string probe;
  double probe_cpu = 1.5;
  std::string probe_from;
};

void describe(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", run::version());
  app.footer(kFooter);
  app.add_option("SCENE", arguments.scene, "Scene file (JSON)")->required();
  app.add_option("--out", arguments.out, "Run directory; made if it is not there")->type_name("DIR");
  app.add_option("-s,--set", arguments.settings, "Change one value of the scene")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("--job-id", arguments.job_id, "Name in live messages; the run's hash if not given")->type_name("ID");
  app.add_option("--sweep-id", arguments.sweep_id, "Sweep that the job belongs to, for the log")->type_name("ID");
  app.add_option("--label", arguments.label, "Swept parameters, shown by viewers")->type_name("TEXT");
  app.add_option("--lcm-url", arguments.lcm_url, "Where live state goes")->type_name("URL")->capture_default_str();
  app.add_flag("--no-lcm", arguments.no_lcm, "Send no live state");
  app.add_option("--threads", arguments.n_threads,
                 "Threads that share each tick: worth it from about 2,000 rods on. The results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--checkpoint-every", arguments.checkpoint_every, "Wall-clock seconds between checkpoints")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--quiet", arguments.quiet, "Show warnings and errors only");
  CLI::Option* probe = app.add_option("--probe", arguments.probe,
                                      "Instead: step a piece of the run, and write what all of it would cost as JSON");
  probe->type_name("FILE");
  app.add_option("--probe-cpu", arguments.probe_cpu, "CPU time of the steps, about; 0 tells only what is on and off")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 3600.0))
      ->needs(probe)
      ->capture_default_str();
  app.add_option("--probe-from", arguments.probe_from, "Directory of a run of the same system, to start from its state")
      ->type_name("DIR")
      ->needs(probe);
}

/// What came out, on stdout; nothing where the summary cannot be read, which has been told then.
void tell_ending(const run::RunDirectory& directory) {
  const Result<std::string> text = read_file(directory.summary());
  if (!text) return;
  const auto summary = nlohmann::json::parse(*text, nullptr, false);
  if (!summary.is_object()) return;
  const std::string ending = run::describe_ending(summary, directory.root);
  if (stderr_goes_to(directory.log())) {  // a run that is done does not fail for a line that its log has no room for
    [[maybe_unused]] const ssize_t written = write(STDOUT_FILENO, ending.data(), ending.size());
    return;
  }
  std::fwrite(ending.data(), 1, ending.size(), stdout);
}

ExitCode run_scene(const scene::RunPlan& plan, const Arguments& arguments) {
  const run::RunDirectory directory{arguments.out};
  run::RunOptions options;
  options.directory = arguments.out;
  options.job_id = arguments.job_id.empty() ? scene::run_id(plan) : arguments.job_id;
  options.label = arguments.label;
  if (!arguments.no_lcm) options.lcm_url = arguments.lcm_url;
  options.n_threads = arguments.n_threads;
  options.checkpoint_every = run::WallSeconds(arguments.checkpoint_every);
  options.stop = &stop_requested;

  std::optional<ProgressLine> line;
  if (!arguments.quiet) {
    const auto size = terminal_size(STDERR_FILENO);
    line.emplace(std::cerr, isatty(STDERR_FILENO) == 1, size ? size->columns : 0, kProgressPeriod);
  }
  run::RunCallbacks callbacks;
  callbacks.on_owned = [&] {
    log_to_file_too(directory.log());
    spdlog::info("run {}{}: {} rods, {} s, in {}", scene::run_id(plan),
                 arguments.sweep_id.empty() ? "" : " of sweep " + arguments.sweep_id, plan.system.n_all_rods(),
                 plan.total_time(), arguments.out);
  };
  callbacks.on_progress = [&](const run::Progress& progress) {
    if (!line) return;
    const std::string text = run::describe_progress(progress);
    run::is_under_way(progress) ? line->show(text) : line->end_with(text);
  };
  callbacks.make_movie = [&](const run::OnDrawn& on_drawn) {
    return run::render_movie(arguments.out, stop_requested, arguments.label, on_drawn);
  };

  const run::RunOutcome outcome = run::run(plan, options, callbacks);
  switch (outcome.state) {
    case run::RunState::kDone:
      spdlog::info("done");
      if (!arguments.quiet) tell_ending(directory);
      return ExitCode::kOk;
    case run::RunState::kStopped:
      spdlog::info("stopped; start again to go on");
      return ExitCode::kStopped;
    case run::RunState::kNoRoom:
      spdlog::error("{}", outcome.message);
      return ExitCode::kNoRoom;
    case run::RunState::kFailed:
      spdlog::error("{}", outcome.message);
      return ExitCode::kFailed;
  }
  return ExitCode::kFailed;
}

/// A simulation of `system` from the state that the run in `folder` was last saved in.
Result<Simulation> resume_from(const std::filesystem::path& folder, const System& system) {
  const run::RunDirectory directory{folder};
  const Result<scene::RunPlan> plan = run::read_plan(directory);
  if (!plan) return plan.error();
  return run::resume_last(directory, scene::run_id(*plan), system);
}

void probe_scene(const scene::RunPlan& plan, const Arguments& arguments) {
  std::optional<run::Probe> probe;
  if (arguments.probe_cpu > 0) {
    Simulation simulation = value_or_fail(
        arguments.probe_from.empty() ? run::start_simulation(plan, "") : resume_from(arguments.probe_from, plan.system),
        ExitCode::kBadInput);
    probe = value_or_fail(run::probe(plan, std::move(simulation), arguments.probe_cpu));
    if (!probe->movie_trouble.empty()) spdlog::warn("the movie could not be timed: {}", probe->movie_trouble);
  }
  done_or_fail(write_file(arguments.probe, run::probe_report(plan, probe).dump(2) + "\n"));
}

ExitCode work(const Arguments& arguments) {
  if (arguments.out.empty() == arguments.probe.empty()) {
    throw Failure(ExitCode::kBadInput, "one of --out and --probe is needed (see `shaken-worker --help`)");
  }
  // A pipe may never say anything: then a signal ends the worker, which has begun nothing.
  std::error_code unknown;
  const bool may_wait = !std::filesystem::is_regular_file(arguments.scene, unknown);
  const auto on_stop = may_wait ? std::signal(SIGTERM, SIG_DFL) : SIG_DFL,
             on_interrupt = may_wait ? std::signal(SIGINT, SIG_DFL) : SIG_DFL;
  const std::string text = value_or_fail(read_input(arguments.scene), ExitCode::kBadInput);
  if (may_wait) {
    std::signal(SIGTERM, on_stop);
    std::signal(SIGINT, on_interrupt);
  }
  const keys::Loaded<scene::RunPlan> plan = scene::load_scene(text, arguments.scene, arguments.settings);
  if (!plan) throw Failure(ExitCode::kBadInput, to_string(plan.error()));
  if (const auto problem = scene::memory_problem(*plan, scene::memory_allowed(), arguments.scene)) {
    throw Failure(ExitCode::kBadInput, to_string(*problem));
  }
  if (const auto problem = scene::placement_problem(*plan, arguments.scene)) {
    throw Failure(ExitCode::kBadInput, to_string(*problem));
  }
  if (arguments.probe.empty()) return run_scene(*plan, arguments);
  std::signal(SIGTERM, SIG_DFL);  // nothing is lost
  std::signal(SIGINT, SIG_DFL);
  probe_scene(*plan, arguments);
  return ExitCode::kOk;
}

}  // namespace

int main(int argc, char** argv) {
  guard_standard_streams("shaken-worker");
  if (argc > 1 && std::string_view(argv[1]) == "replay") return run::replay_command(argc - 1, argv + 1);
  CLI::App app("Runs one scene from start to end in a run directory.", "shaken-worker");
  app.formatter(std::make_shared<HelpFormatter>());
  Arguments arguments;
  describe(app, arguments);
  std::signal(SIGTERM, request_stop);
  std::signal(SIGINT, request_stop);
  // a terminal that is closed; nohup asks to outlive it
  if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    app.parse(argc, argv);
    log_to_stderr(arguments.quiet);
    return static_cast<int>(work(arguments));
  } catch (const CLI::ParseError& problem) {
    if (problem.get_exit_code() == 0) return app.exit(problem);
    complain(fmt::format("shaken-worker: {} (see `shaken-worker --help`)", problem.what()));
    return static_cast<int>(ExitCode::kBadInput);
  } catch (const Failure& failure) {
    complain(printable(failure.what(), Lines::kMany));
    return static_cast<int>(failure.code);
  }
}
