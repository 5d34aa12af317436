// SPDX-License-Identifier: MIT
#include "web/served.h"

#include <httplib.h>

#include <nlohmann/json.hpp>

namespace shaken::web {

bool is_served(const std::filesystem::path& root, int port, const std::string& token) {
  httplib::Client other("127.0.0.1", port);
  other.set_connection_timeout(1);
  other.set_read_timeout(5);
  const auto answer = other.Get("/v1/status", httplib::Headers{{"Authorization", "Bearer " + token}});
  if (!answer || answer->status != 200) return false;
  const nlohmann::json status = nlohmann::json::parse(answer->body, nullptr, false);
  return status.is_object() && status.value("root", "") == root.lexically_normal().string();
}

}  // namespace shaken::web
