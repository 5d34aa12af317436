// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "server/http/http_server.h"

namespace shaken::web {

/// Decides who sees the page. Every user of the machine, and every web site that its browser has open, can send
/// requests to a port of 127.0.0.1; the token is what they do not know.
class Guard {
 public:
  Guard(std::string token, int port);

  /// What to answer in place of what was asked for; nothing if the request may pass. It must
  /// - be addressed to 127.0.0.1 or localhost and this port: a name that a web site makes point here is refused (403);
  /// - come from this page, or from no page, if it changes something (403);
  /// - carry the token: in the cookie that the page's address has left, or as "Authorization: Bearer TOKEN" (401).
  /// "/?token=TOKEN" is answered with that cookie, and with the address without the token (303).
  std::optional<server::Reply> stop(const server::Request& request) const;

  /// What to open in a browser.
  std::string address() const;

 private:
  bool is_host(const std::string& host) const;
  bool knows_token(const server::Request& request) const;
  /// Cookies are shared by all ports of a machine, so its name has the port.
  std::string cookie_name() const { return "shaken_" + std::to_string(port_); }

  std::string token_;
  int port_;
};

}  // namespace shaken::web
