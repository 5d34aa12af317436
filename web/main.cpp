#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/interrupt.h"
#include "base/memory.h"
#include "base/paths.h"
#include "base/program.h"
#include "run/files/version.h"
#include "web/guard.h"
#include "web/run_reader.h"
#include "web/served_page.h"
#include "web/site.h"

namespace shaken::web {
namespace {

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

/// The bus that the daemon's workers send to; null with the reason on stderr.
std::unique_ptr<proto::Bus> open_bus(const DaemonLink& daemon, std::string url) {
  if (url.empty()) {
    const Result<std::string> answer = daemon.get("/v1/status");
    if (!answer) throw Failure(ExitCode::kNoDaemon, answer.error().message);
    const nlohmann::json lcm = nlohmann::json::parse(*answer, nullptr, false).value("lcm", nlohmann::json::object());
    if (!lcm.value("ok", false)) {
      std::fprintf(stderr, "shaken-web: nothing is live: %s\n", lcm.value("message", "the daemon has no LCM").c_str());
      return nullptr;
    }
    url = lcm.value("url", "");
  }
  Result<std::unique_ptr<proto::Bus>> bus = proto::Bus::open(url);
  if (bus) return std::move(bus).value();
  std::fprintf(stderr, "shaken-web: nothing is live: %s\n", bus.error().message.c_str());
  return nullptr;
}

/// Serves the page of the daemon of `root` on a port of 127.0.0.1 (0: any that is free) until SIGINT or SIGTERM, and
/// prints its address. If the page is served already, it prints that address and returns. Live state comes from
/// `lcm_url`, from where the daemon sends it if that is empty, and not at all with `no_lcm`. Throws Failure.
void serve(const std::filesystem::path& root, int port, const std::string& lcm_url, bool no_lcm) {
  Result<ServedPage> page = ServedPage::claim(root);
  if (!page) {
    const auto address = served_address(root);
    if (!address)
      throw Failure(ExitCode::kFailed, "cannot serve the page of " + root.string() + ": " + page.error().message);
    std::printf("open %s\nit is served already\n", address->c_str());
    return;
  }
  SiteSetup setup{.root = root, .page = shipped_page()};
  if (!no_lcm) setup.bus = open_bus(DaemonLink(root), lcm_url);
  if (!std::filesystem::exists(setup.chart_library)) {
    throw Failure(ExitCode::kFailed, "there is no " + setup.chart_library.string() +
                                         ", which draws the curves: apt-get install libjs-chart.js");
  }
  const std::string token = value_or_fail(make_token());
  Site site(std::move(setup));
  const InterruptGuard interrupt;
  std::promise<Guard> promised;  // requests wait until the port is known
  const std::shared_future<Guard> guard = promised.get_future();
  const auto listen_on = [&](int wanted) {
    return std::make_unique<http::HttpServer>(
        wanted, [&](const http::Request& head) { return guard.get().stop(head); },
        [&](const http::Request& request) { return site.answer(request); }, Guard::headers());
  };
  std::unique_ptr<http::HttpServer> server = listen_on(port);
  const int served_port = server->port();
  promised.set_value(Guard(token, served_port));
  const std::string address = guard.get().address();
  done_or_fail(page->announce(address));
  std::printf("open %s\n", address.c_str());
  std::fflush(stdout);
  std::vector<std::unique_ptr<http::HttpServer>> former;  // which may have to answer still
  std::string last_failure;
  while (!interrupt.interrupted()) {
    keep_memory_in_reserve();
    interrupt.sleep_for(std::chrono::seconds(1));
    std::erase_if(former, [](const auto& one) { return one->ended_within(std::chrono::milliseconds(0)); });
    if (server && !server->has_failed()) continue;
    if (server) server->close();
    if (server) former.push_back(std::move(server));
    try {
      server = listen_on(served_port);
      std::fprintf(stderr, "shaken-web: the port failed: listening anew\n");
      last_failure.clear();
    } catch (const std::exception& failure) {  // in a second again
      server.reset();
      if (std::exchange(last_failure, failure.what()) != failure.what()) {
        std::fprintf(stderr, "shaken-web: %s; trying again each second\n", failure.what());
      }
    }
  }
  site.close();
  if (server) server->close();
  for (const auto& one : former) one->close();
  const auto has_ended = [](const auto& one) { return one->ended_within(std::chrono::milliseconds(1000)); };
  // A browser that does not take its answer must not keep this program up.
  if ((server && !has_ended(server)) || !std::all_of(former.begin(), former.end(), has_ended)) {
    { const ServedPage last = std::move(*page); }
    std::_Exit(EXIT_SUCCESS);
  }
}

}  // namespace
}  // namespace shaken::web

int main(int argc, char** argv) {
  using namespace shaken;
  if (argc > 1 && std::string_view(argv[1]) == "read") {
    guard_standard_streams("shaken-web");
    return web::read_run_command(argc, argv);
  }
  std::signal(SIGPIPE, SIG_IGN);
  Program app("shaken-web", web::kAbout, web::kExamples);
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
