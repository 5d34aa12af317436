#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/http/http_server.h"

namespace shaken::web {

using Json = nlohmann::ordered_json;

/// JSON as text: what is not UTF-8 in it is replaced.
inline std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

inline http::Reply json_reply(const Json& json) { return {.status = 200, .body = text_of(json) + "\n"}; }

inline http::Reply refusal(int status, const std::string& reason) {
  return {.status = status, .body = text_of({{"error", reason}}) + "\n"};
}

}  // namespace shaken::web
