#include "proto/relay/address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <charconv>

namespace shaken::relay {

std::string Address::text() const {
  const in_addr address{htonl(host)};
  char words[INET_ADDRSTRLEN] = {};
  inet_ntop(AF_INET, &address, words, sizeof(words));
  return std::string(words) + ":" + std::to_string(port);
}

std::string Address::url() const {
  const Address reached{host == INADDR_ANY ? INADDR_LOOPBACK : host, port};
  return "tcpq://" + reached.text();
}

Result<Address> parse_address(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string host(text.substr(0, colon));
  const std::string_view port = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  in_addr address{};
  Address result;
  const auto [end, problem] = std::from_chars(port.data(), port.data() + port.size(), result.port);
  if (inet_pton(AF_INET, host.c_str(), &address) != 1 || problem != std::errc() || end != port.data() + port.size()) {
    return Error{std::string("'").append(text) + "' is no address in four numbers with a port, such as 127.0.0.1:7700"};
  }
  result.host = ntohl(address.s_addr);
  return result;
}

}  // namespace shaken::relay
