#include "web/daemon_link.h"

#include <httplib.h>

#include "web/json_reply.h"

namespace shaken::web {

http::Reply DaemonLink::ask(const http::Request& request) const {
  const std::filesystem::path socket = root_ / "shakend.sock";
  httplib::Client daemon(socket.string());
  daemon.set_address_family(AF_UNIX);
  daemon.set_connection_timeout(2);
  daemon.set_read_timeout(patience_);
  httplib::Params query;
  for (const auto& [name, value] : request.query) query.emplace(name, value);
  const httplib::Result answer = request.method == "POST" ? daemon.Post(request.path, request.body, "application/json")
                                                          : daemon.Get(request.path, query, httplib::Headers{});
  if (!answer) {
    return refusal(503, "no daemon answers at " + socket.string() + " (" + httplib::to_string(answer.error()) +
                            "): start shakend");
  }
  return {.status = answer->status, .body = answer->body, .allow = answer->get_header_value("Allow")};
}

Result<std::string> DaemonLink::get(const std::string& path) const {
  http::Reply reply = ask({.method = "GET", .path = path, .query = {}, .body = ""});
  if (reply.status == 200) return std::move(reply.body);
  const Json body = Json::parse(reply.body, nullptr, false);
  return Error{body.is_object() ? body.value("error", reply.body) : reply.body};
}

}  // namespace shaken::web
