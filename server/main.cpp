// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>

#include "base/failure.h"
#include "base/help_formatter.h"
#include "base/paths.h"
#include "base/standard_streams.h"
#include "proto/bus.h"
#include "proto/relay/address.h"
#include "run/files/version.h"
#include "scene/slurm_settings.h"
#include "server/daemon.h"
#include "server/terms.h"

namespace {

using shaken::ExitCode;
using shaken::Failure;

constexpr const char* kAbout =
    "shakend: runs queued simulations of shaken rods, one worker process per run.\n"
    "Stays in the foreground; SIGTERM or Ctrl-C stops it in order, and the next start goes on where it stopped.";

constexpr const char* kExamples =
    "Examples:\n"
    "  shakend                              # ~/.local/share/shaken, one worker per core\n"
    "  shakend --root /data/rods --slots 8 --keep-free 20GB\n"
    "  shakend --root /tmp/try --no-lcm &   # no live state, nothing on the network; behind a prompt it is quiet\n"
    "  shakend --relay 127.0.0.1:7700       # live state for tcpq://127.0.0.1:7700 too, where multicast does not "
    "reach\n"
    "  shakend --web                        # and a page for the browser of this machine\n"
    "  shakend --executor slurm --runs-per-task 10 --slurm-option=--partition=short   # runs as job arrays\n"
    "  curl --unix-socket /tmp/try/shakend.sock http://shaken/v1/status\n"
    "\n"
    "Exit codes: 0 stopped in order, 1 could not start or lost its disk, 2 bad arguments.";

std::string slurm_option(const std::string& option) { return shaken::scene::slurm_option_problem(option).value_or(""); }

/// Whether stderr is a terminal on which somebody else is at work: a log there would run into what is typed.
bool behind_a_prompt() { return isatty(STDERR_FILENO) == 1 && tcgetpgrp(STDERR_FILENO) != getpgrp(); }

shaken::relay::Address relay_address(const std::string& text, bool for_anyone) {
  const auto address = shaken::relay::parse_address(text);
  if (!address) throw Failure(ExitCode::kBadInput, "--relay: " + address.error().message);
  if (!address->is_loopback() && !for_anyone) {
    throw Failure(
        ExitCode::kBadInput,
        "--relay " + text +
            " can be reached from other machines, and tcpq has no password: whoever reaches it can listen and "
            "send. Give 127.0.0.1 and use ssh -L, or add --relay-for-anyone");
  }
  return *address;
}

}  // namespace

int main(int argc, char** argv) {
  shaken::guard_standard_streams("shakend");
  shaken::server::DaemonConfig config;
  std::string root;
  config.worker = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "shaken-worker";
  config.slots = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  config.lcm_url = shaken::proto::default_url();
  std::string executor = std::string(shaken::server::kLocal);
  double slurm_poll = 10;
  bool foreground = true;
  bool no_lcm = false;
  bool web = false;
  int web_port = 8642;
  std::string relay;
  bool relay_for_anyone = false;

  CLI::App app(kAbout);
  app.formatter(std::make_shared<shaken::HelpFormatter>());
  app.footer(kExamples);
  app.set_version_flag("--version", std::string("shakend ") + shaken::run::version());
  app.add_option("--root", root,
                 "Directory of queue, socket, log and runs [default: $SHAKEN_ROOT, else "
                 "$XDG_DATA_HOME/shaken, else ~/.local/share/shaken]")
      ->type_name("DIR");
  app.add_option("--slots", config.slots, "Workers that may run at once")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--threads", config.threads,
                 "Threads that share each tick of a worker: worth it from about 2,000 rods on, with fewer slots")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--keep-free", config.keep_free, "Room on the disk below which no run is started: 20GB, say")
      ->transform(CLI::AsSizeValue(true))
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 60))
      ->type_name("SIZE")
      ->capture_default_str();
  auto* url = app.add_option("--lcm-url", config.lcm_url,
                             "Where live state goes [default: $LCM_DEFAULT_URL, else "
                             "multicast on this machine]")
                  ->type_name("URL");
  auto* silent = app.add_flag("--no-lcm", no_lcm, "Send no live state")->excludes(url);
  auto* relay_at =
      app.add_option("--relay", relay,
                     "Hand LCM messages on over TCP at this address: clients use tcpq://127.0.0.1:7700, say")
          ->type_name("ADDRESS:PORT")
          ->excludes(silent);
  app.add_flag(
         "--relay-for-anyone", relay_for_anyone,
         "Let --relay listen where other machines reach it: there is no password, whoever reaches it can listen and "
         "send")
      ->needs(relay_at);
  auto* page =
      app.add_flag("--web", web, "Show the queue, results and live rods in a browser: prints the address to open");
  app.add_option("--web-port", web_port, "Port of 127.0.0.1 for the page; 0: any that is free")
      ->needs(page)
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--executor", executor, "Where runs of sweeps run that do not say so themselves (docs/cluster.md)")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  app.add_option("--max-pending", config.max_pending, "Tasks that wait in Slurm's queue at most")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--runs-per-task", config.runs_per_task,
                 "Runs that a task of Slurm does, one after the other, where a sweep does not say")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  app.add_option("--slurm-option", config.slurm_options, "Option of sbatch for every run, as --slurm-option=--qos=low")
      ->type_name("OPTION")
      ->allow_extra_args(false)
      ->check(slurm_option);
  app.add_option("--slurm-poll", slurm_poll, "Time from one question to Slurm to the next")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--worker", config.worker, "Program that does one run [default: shaken-worker beside shakend]")
      ->type_name("FILE");
  app.add_option("--log-level", config.log_level, "What goes to stderr and ROOT/shakend.log")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
  app.add_flag("--quiet", config.quiet,
               "Log to ROOT/shakend.log only; also where it is started in the background of a terminal (`shakend &`)");
  app.add_flag("--foreground", foreground, "Stay in the foreground: the only mode, for service managers");
  try {
    app.parse(argc, argv);
    config.root = shaken::value_or_fail(shaken::data_root(root), ExitCode::kBadInput);
    config.quiet = config.quiet || behind_a_prompt();
    const char* lcm_default = std::getenv("LCM_DEFAULT_URL");
    config.lcm_url_is_asked_for = url->count() > 0 || (lcm_default != nullptr && *lcm_default != '\0');
    if (no_lcm) config.lcm_url.clear();
    if (!relay.empty()) config.relay = relay_address(relay, relay_for_anyone);
    if (web) config.web_port = web_port;
    config.slurm_is_default = executor == shaken::server::kSlurm;
    config.slurm_poll = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * slurm_poll));
    shaken::server::run_daemon(config);
    return static_cast<int>(ExitCode::kOk);
  } catch (const CLI::ParseError& outcome) {
    if (outcome.get_exit_code() == 0) return app.exit(outcome);
    std::fprintf(stderr, "shakend: %s (see `shakend --help`)\n", outcome.what());
    return static_cast<int>(ExitCode::kBadInput);
  } catch (const shaken::Failure& failure) {
    std::fprintf(stderr, "shakend: %s\n", failure.what());
    return static_cast<int>(failure.code);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "shakend: %s\n", problem.what());
    return static_cast<int>(ExitCode::kFailed);
  }
}
