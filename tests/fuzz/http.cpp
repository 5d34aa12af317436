// The bytes of one connection to the daemon's socket, sent at once: it must answer in HTTP, or close.
#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>

#include "base/descriptor.h"
#include "base/http/http_server.h"
#include "base/scratch_folder.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

namespace {

struct Listening {
  ScratchFolder folder;
  http::HttpServer server{folder.path() / "s", [](const http::Request& request) {
                            return http::Reply{200, "{\"size\":" + std::to_string(request.body.size()) + "}", ""};
                          }};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Listening daemon;
  const Descriptor connection(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (daemon.folder.path() / "s").string();
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  fuzz::promise(connect(connection.value(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0,
                "the daemon listens");
  // What does not fit into the socket at once is not sent: nobody reads answers meanwhile.
  (void)send(connection.value(), data, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  shutdown(connection.value(), SHUT_WR);
  std::string answer;
  char buffer[4096];
  for (ssize_t n = 0; (n = recv(connection.value(), buffer, sizeof(buffer), 0)) > 0;) {
    if (answer.size() < sizeof(buffer)) answer.append(buffer, static_cast<std::size_t>(n));
  }
  fuzz::promise(answer.empty() || answer.starts_with("HTTP/1."), "an answer is HTTP");
  return 0;
}
