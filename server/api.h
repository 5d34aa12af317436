#pragma once

#include <utility>

#include "base/http/http_server.h"
#include "server/answers.h"
#include "server/daemon_info.h"
#include "server/queue/queue.h"

namespace shaken::server {

/// The control API of docs/protocol.md: from a request to an answer, by one table of routes. Writes only to the
/// queue; may be called from many threads at once.
class Api {
 public:
  Api(Queue& queue, DaemonInfo info) : queue_(queue), info_(std::move(info)) {}

  /// Never throws: whatever goes wrong is an answer of 4xx or 5xx with {"error": "..."}.
  http::Reply handle(const http::Request& request) const;

 private:
  Queue& queue_;
  DaemonInfo info_;
};

}  // namespace shaken::server
