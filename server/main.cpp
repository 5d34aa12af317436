#include <unistd.h>

#include <cstdlib>
#include <string>

#include "base/failure.h"
#include "base/paths.h"
#include "base/processor.h"
#include "base/program.h"
#include "proto/bus.h"
#include "proto/relay/address.h"
#include "run/files/version.h"
#include "scene/sweeps/slurm_settings.h"
#include "server/daemon.h"
#include "server/queue/terms.h"

namespace shaken::server {
namespace {

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

std::string slurm_option(const std::string& option) { return scene::slurm_option_problem(option).value_or(""); }

/// Whether stderr is a terminal on which somebody else is at work: a log there would run into what is typed.
bool behind_a_prompt() { return isatty(STDERR_FILENO) == 1 && tcgetpgrp(STDERR_FILENO) != getpgrp(); }

relay::Address relay_address(const std::string& text, bool for_anyone) {
  const auto address = relay::parse_address(text);
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

/// The command line of shakend.
class DaemonOptions {
 public:
  /// Declares the options; defaults are those of this machine.
  explicit DaemonOptions(CLI::App& app);

  /// What the command line asks for, once it is parsed. Throws Failure (kBadInput).
  DaemonConfig config() const;

 private:
  DaemonConfig config_;
  std::string root_;
  std::string executor_ = std::string(kLocal);
  double slurm_poll_ = 10;  ///< [s]
  CLI::Option* url_ = nullptr;
  bool no_lcm_ = false;
  bool web_ = false;
  int web_port_ = 8642;
  std::string relay_;
  bool relay_for_anyone_ = false;
};

DaemonOptions::DaemonOptions(CLI::App& app) {
  config_.worker = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "shaken-worker";
  config_.slots = allowed_cores();
  config_.lcm_url = proto::default_url();
  app.add_option("--root", root_,
                 "Directory of queue, socket, log and runs [default: $SHAKEN_ROOT, else "
                 "$XDG_DATA_HOME/shaken, else ~/.local/share/shaken]")
      ->type_name("DIR");
  app.add_option("--slots", config_.slots, "Workers that may run at once")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--threads", config_.threads,
                 "Threads that share each tick of a worker: worth it from about 2,000 rods on, with fewer slots")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--keep-free", config_.keep_free, "Room on the disk below which no run is started: 20GB, say")
      ->transform(CLI::AsSizeValue(true))
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 60))
      ->type_name("SIZE")
      ->capture_default_str();
  url_ = app.add_option("--lcm-url", config_.lcm_url,
                        "Where live state goes [default: $LCM_DEFAULT_URL, else "
                        "multicast on this machine]")
             ->type_name("URL");
  auto* silent = app.add_flag("--no-lcm", no_lcm_, "Send no live state")->excludes(url_);
  auto* relay_at =
      app.add_option("--relay", relay_,
                     "Hand LCM messages on over TCP at this address: clients use tcpq://127.0.0.1:7700, say")
          ->type_name("ADDRESS:PORT")
          ->excludes(silent);
  app.add_flag(
         "--relay-for-anyone", relay_for_anyone_,
         "Let --relay listen where other machines reach it: there is no password, whoever reaches it can listen and "
         "send")
      ->needs(relay_at);
  auto* page =
      app.add_flag("--web", web_, "Show the queue, results and live rods in a browser: prints the address to open");
  app.add_option("--web-port", web_port_, "Port of 127.0.0.1 for the page; 0: any that is free")
      ->needs(page)
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--executor", executor_, "Where runs of sweeps run that do not say so themselves (docs/cluster.md)")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  app.add_option("--max-pending", config_.max_pending, "Tasks that wait in Slurm's queue at most")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--runs-per-task", config_.runs_per_task,
                 "Runs that a task of Slurm does, one after the other, where a sweep does not say")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  app.add_option("--slurm-option", config_.slurm_options, "Option of sbatch for every run, as --slurm-option=--qos=low")
      ->type_name("OPTION")
      ->allow_extra_args(false)
      ->check(slurm_option);
  app.add_option("--slurm-poll", slurm_poll_, "Time from one question to Slurm to the next")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--worker", config_.worker, "Program that does one run [default: shaken-worker beside shakend]")
      ->type_name("FILE");
  app.add_option("--log-level", config_.log_level, "What goes to stderr and ROOT/shakend.log")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
  app.add_flag("--quiet", config_.quiet,
               "Log to ROOT/shakend.log only; also where it is started in the background of a terminal (`shakend &`)");
}

DaemonConfig DaemonOptions::config() const {
  DaemonConfig config = config_;
  config.root = value_or_fail(data_root(root_), ExitCode::kBadInput);
  config.quiet = config.quiet || behind_a_prompt();
  const char* lcm_default = std::getenv("LCM_DEFAULT_URL");
  config.lcm_url_is_asked_for = url_->count() > 0 || (lcm_default != nullptr && *lcm_default != '\0');
  if (no_lcm_) config.lcm_url.clear();
  if (!relay_.empty()) config.relay = relay_address(relay_, relay_for_anyone_);
  if (web_) config.web_port = web_port_;
  config.slurm_is_default = executor_ == kSlurm;
  config.slurm_poll = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * slurm_poll_));
  return config;
}

}  // namespace
}  // namespace shaken::server

int main(int argc, char** argv) {
  shaken::Program app("shakend", shaken::server::kAbout, shaken::server::kExamples);
  app.set_version_flag("--version", std::string("shakend ") + shaken::run::version());
  const shaken::server::DaemonOptions options(app);
  return app.run(argc, argv, [&] {
    shaken::server::run_daemon(options.config());
    return shaken::ExitCode::kOk;
  });
}
