// A request to the daemon as the HTTP server hands it on: "METHOD path?key=value&key=value", a line break, the body.
// Every one must get an answer that is JSON.
#include "server/api.h"

#include <spdlog/spdlog.h>

#include <memory>

#include "base/scratch_folder.h"
#include "scene/sweeps/sweep.h"
#include "server/submission.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;
using namespace shaken::server;

namespace {

/// A daemon's queue, emptied now and then: what was submitted must not slow down what comes.
struct Daemon {
  ScratchFolder folder;
  Queue queue{folder.path() / "queue.db"};
  Api api{queue, [this] {
            DaemonInfo info;
            info.root = folder.path();
            return info;
          }()};
};

/// Few rods in few runs: whether rods can be placed takes as long as a start.
bool is_small(const std::string& body) {
  const auto read = submit_keys().read(body, "body");
  if (!read) return true;
  const SubmitRequest& request = *read;
  if (request.text.size() > 2000 || request.replicas.value_or(1) > 3) return false;
  const auto sweep = scene::load_sweep(request.text, request.file, request.settings, request.replicas);
  if (!sweep) return true;
  if (sweep->points.size() > 4) return false;
  for (const scene::SweepPoint& point : sweep->points) {
    if (point.plan.system.n_all_rods() > 100) return false;
  }
  return true;
}

http::Request request_of(std::string_view text) {
  http::Request request;
  const std::size_t line = std::min(text.find('\n'), text.size());
  std::string_view head = text.substr(0, line);
  request.body = text.substr(std::min(line + 1, text.size()));
  const std::size_t space = std::min(head.find(' '), head.size());
  request.method = head.substr(0, space);
  head.remove_prefix(std::min(space + 1, head.size()));
  const std::size_t question = std::min(head.find('?'), head.size());
  request.path = head.substr(0, question);
  head.remove_prefix(std::min(question + 1, head.size()));
  while (!head.empty()) {
    const std::size_t end = std::min(head.find('&'), head.size());
    const std::string_view pair = head.substr(0, end);
    const std::size_t equals = std::min(pair.find('='), pair.size());
    request.query.emplace(pair.substr(0, equals), pair.substr(std::min(equals + 1, pair.size())));
    head.remove_prefix(std::min(end + 1, head.size()));
  }
  return request;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::unique_ptr<Daemon> daemon;
  static int n_used = 0;
  spdlog::set_level(spdlog::level::off);  // what is submitted is logged
  if (!daemon || ++n_used % 2000 == 0) {
    daemon.reset();
    daemon = std::make_unique<Daemon>();
  }
  const http::Request request = request_of(fuzz::text_of(data, size));
  if (!is_small(request.body)) return 0;
  const http::Reply reply = daemon->api.handle(request);
  fuzz::promise(reply.status >= 200 && reply.status < 500, "whatever is asked is no error of the daemon");
  fuzz::promise(Json::accept(reply.body), "an answer is JSON");
  return 0;
}
