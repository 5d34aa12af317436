#include "base/http/http_server.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <future>
#include <string>

#include "base/descriptor.h"
#include "tests/unit/server/server_support.h"

namespace shaken::http {
namespace {

sockaddr_un address_of(const std::filesystem::path& socket) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socket.native().copy(address.sun_path, sizeof(address.sun_path) - 1);
  return address;
}

/// The descriptor that this process listens with; -1 if there is none.
int listener_of(const std::filesystem::path& socket) {
  for (int fd = 0; fd < 1024; ++fd) {
    int listens = 0;
    socklen_t size = sizeof(listens);
    if (getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || listens == 0) continue;
    sockaddr_un address{};
    size = sizeof(address);
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 && socket == address.sun_path) return fd;
  }
  return -1;
}

Descriptor connect_to(const std::filesystem::path& socket) {
  Descriptor client(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_un address = address_of(socket);
  if (connect(client.value(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) return Descriptor();
  return client;
}

std::string ask(const Descriptor& client) {
  const std::string request = "GET /x HTTP/1.1\r\nHost: localhost\r\n\r\n";
  if (send(client.value(), request.data(), request.size(), MSG_NOSIGNAL) < 0) return "";
  std::string answer;
  char piece[4096];
  while (!answer.ends_with('}')) {  // head and body may come one after the other
    const ssize_t n = recv(client.value(), piece, sizeof(piece), 0);
    if (n <= 0) break;
    answer.append(piece, static_cast<std::size_t>(n));
  }
  return answer;
}

// An accept() that fails ends the listening, but not before the last connection has ended: until then nobody else would
// be answered, if nobody looked.
TEST(HttpServer, AListenerThatFailsIsSeenWhileSomebodyIsServed) {
  const ScratchFolder folder;
  const auto socket = folder / "socket";
  std::promise<void> asked, release;
  HttpServer server(socket, [&](const Request&) {
    asked.set_value();
    release.get_future().wait();
    return Reply{.body = "{\"here\": 1}"};
  });
  const Descriptor served = connect_to(socket);
  std::future<std::string> answer = std::async(std::launch::async, [&] { return ask(served); });
  asked.get_future().wait();  // it is being answered from here on
  EXPECT_FALSE(server.has_failed());

  const int listener = listener_of(socket);
  ASSERT_GE(listener, 0);
  shutdown(listener, SHUT_RDWR);  // accept() fails
  EXPECT_TRUE(server::eventually([&] { return server.has_failed(); }));
  EXPECT_FALSE(server.ended_within(std::chrono::milliseconds(0))) << "somebody is being answered still";
  release.set_value();
  EXPECT_NE(answer.get().find("here"), std::string::npos);
  ASSERT_TRUE(server.ended_within(std::chrono::seconds(10)));

  const int other = open("/dev/null", O_RDONLY | O_CLOEXEC);  // the lowest number that is free
  EXPECT_EQ(other, listener) << "it was closed";
  server.close();
  EXPECT_GE(fcntl(other, F_GETFD), 0) << "what another file has got is not closed";
  close(other);

  HttpServer next(socket, [](const Request&) { return Reply{.body = "{\"here\": 1}"}; });
  const Descriptor client = connect_to(socket);
  EXPECT_NE(ask(client).find("here"), std::string::npos);
}

// One that is closed late must not take the socket of its successor away.
TEST(HttpServer, RemovesNoSocketButItsOwn) {
  const ScratchFolder folder;
  const auto socket = folder / "socket";
  const HttpServer::Handler handler = [](const Request&) { return Reply{.body = "{\"here\": 1}"}; };
  HttpServer former(socket, handler);
  HttpServer next(socket, handler);
  former.close();
  EXPECT_TRUE(next.is_reachable());
  EXPECT_NE(ask(connect_to(socket)).find("here"), std::string::npos);
  next.close();
  EXPECT_FALSE(std::filesystem::exists(socket));
}

}  // namespace
}  // namespace shaken::http
