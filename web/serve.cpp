#include "web/serve.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/interrupt.h"
#include "base/memory_reserve.h"
#include "base/paths.h"
#include "web/guard.h"
#include "web/served_page.h"
#include "web/site.h"
#include "web/token.h"

namespace shaken::web {
namespace {

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

}  // namespace

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

}  // namespace shaken::web
