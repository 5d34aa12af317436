#include "client/live/json.h"

#include "base/text.h"

namespace shaken::client {

std::string json_text(const Json& json) {
  // printable() escapes as JSON does; what is no UTF-8 has no form in JSON.
  return printable(json.dump(2, ' ', false, Json::error_handler_t::replace), Lines::kMany) + "\n";
}

}  // namespace shaken::client
