#include "proto/relay/address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include "base/text.h"

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
  const auto port = number_in<std::uint16_t>(colon == std::string_view::npos ? "" : text.substr(colon + 1));
  in_addr address{};
  if (inet_pton(AF_INET, host.c_str(), &address) != 1 || !port) {
    return Error{std::string("'").append(text) + "' is no address in four numbers with a port, such as 127.0.0.1:7700"};
  }
  return Address{ntohl(address.s_addr), *port};
}

}  // namespace shaken::relay
