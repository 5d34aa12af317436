#include <csignal>
#include <string>
#include <string_view>

#include "base/paths.h"
#include "base/program.h"
#include "run/files/version.h"
#include "web/read_run.h"
#include "web/serve.h"

namespace {

using namespace shaken;

constexpr const char* kAbout =
    "shaken-web: a daemon's queue, its results and its live rods in a browser of this machine.\n"
    "Prints the address to open, with the token that lets one in, and serves it until Ctrl-C or SIGTERM.";

constexpr const char* kExamples =
    "Examples:\n"
    "  shakend --web                        # the daemon starts this program beside itself\n"
    "  shaken web                           # the same by hand, for a daemon that runs already\n"
    "  shaken-web --root /data/rods --port 9000\n"
    "  ssh -L 8642:127.0.0.1:8642 desk      # from elsewhere: then open the same address there\n"
    "\n"
    "Exit codes: 0 stopped in order, 1 could not start, 2 bad arguments, 3 no daemon.";

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "read") {
    guard_standard_streams("shaken-web");
    return web::read_run_command(argc, argv);
  }
  std::signal(SIGPIPE, SIG_IGN);
  Program app("shaken-web", kAbout, kExamples);
  std::string root, lcm_url;
  int port = 8642;
  bool no_lcm = false;
  app.set_version_flag("--version", std::string("shaken-web ") + run::version());
  app.add_option("--root", root, "The daemon's root directory [default: as shakend]")->type_name("DIR");
  app.add_option("--port", port, "Of 127.0.0.1; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  auto* url =
      app.add_option("--lcm-url", lcm_url, "Where live state comes from [default: asks the daemon]")->type_name("URL");
  app.add_flag("--no-lcm", no_lcm, "Listen to no live state")->excludes(url);
  return app.run(argc, argv, [&] {
    web::serve(value_or_fail(data_root(root), ExitCode::kBadInput), port, lcm_url, no_lcm);
    return ExitCode::kOk;
  });
}
