#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/http/http_server.h"
#include "base/process.h"
#include "web/daemon_link.h"
#include "web/guard.h"
#include "web/live_feed.h"
#include "web/queue_feed.h"
#include "web/run_reader.h"

namespace shaken::web {

struct SiteSetup {
  std::filesystem::path root;            ///< of the daemon
  std::filesystem::path page;            ///< folder of the page's files
  std::unique_ptr<proto::Bus> bus = {};  ///< null: nothing is live
  std::filesystem::path chart_library = "/usr/share/javascript/chart.js/chart.min.js";
  std::filesystem::path renderer = sibling_program("shaken-render");
  std::chrono::milliseconds drawing = std::chrono::minutes(2);  ///< for one picture, then its renderer is killed
  std::filesystem::path client = sibling_program("shaken");
  std::chrono::milliseconds estimating = std::chrono::minutes(2);  ///< for what one scene would cost
};

/// What is served to a browser that may see it (docs/web.md has the paths): the page, the daemon's interface, what runs
/// have recorded, and, as server-sent events, the queue and live rods.
class Site {
 public:
  explicit Site(SiteSetup setup);

  /// Called from many threads at once; never throws.
  http::Reply answer(const http::Request& request);
  /// Streams end soon after this.
  void close() { is_closing_ = true; }

 private:
  http::Reply routed(const http::Request& request);
  http::Reply page_file(const std::string& name) const;
  /// A stream of events of the queue, and of a run if one is named.
  http::Reply events(const std::string& run);
  http::Reply ticket(const http::Request& request);
  http::Reply of_run(const std::string& run, const std::vector<std::string>& rest, const http::Request& request);
  /// The newest frame: live where the run is at work and streams, otherwise the last that is recorded.
  http::Reply newest(const std::string& run);
  http::Reply curves(const std::string& run, const http::Request& request);
  std::filesystem::path directory(const std::string& run) const { return setup_.root / "runs" / run; }
  http::Reply file(const std::string& run, const std::string& name) const;
  http::Reply picture(const std::string& run, const http::Request& request);
  /// What a scene or sweep, `{"text", "replicas"?}`, would cost on this machine: `shaken submit --dry-run` steps a
  /// piece of some of its runs, which takes some CPU-seconds. 400: no such body; 422: no scene that can be run; 429:
  /// another one is being made; 504: it takes too long.
  http::Reply cost(const http::Request& request);

  SiteSetup setup_;
  DaemonLink daemon_;
  DaemonLink looks_;  ///< for the queue's feed, whose end must not wait long
  RunReader reader_;
  std::optional<LiveFeed> live_;
  std::atomic<bool> is_closing_ = false;
  Tickets tickets_;
  std::mutex drawing_;              ///< one picture at a time: the cores are the runs'
  std::mutex estimating_;           ///< likewise
  std::optional<QueueFeed> queue_;  ///< the last: its thread uses the others
};

}  // namespace shaken::web
