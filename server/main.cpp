#include <string>

#include "base/program.h"
#include "run/files/version.h"
#include "server/daemon.h"
#include "server/daemon_options.h"

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

}  // namespace

int main(int argc, char** argv) {
  shaken::Program app("shakend", kAbout, kExamples);
  app.set_version_flag("--version", std::string("shakend ") + shaken::run::version());
  const shaken::server::DaemonOptions options(app);
  return app.run(argc, argv, [&] {
    shaken::server::run_daemon(options.config());
    return shaken::ExitCode::kOk;
  });
}
