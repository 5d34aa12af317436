#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>

namespace shaken {

/// Listens on a port of this machine. What connects is accepted by the kernel, and hears nothing unless it is greeted.
class LazyServer {
 public:
  LazyServer() {
    const int little = 2048;
    setsockopt(listener_, SOL_SOCKET, SO_RCVBUF, &little, sizeof(little));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(bind(listener_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(listener_, 5), 0);
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    url_ = "tcpq://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  LazyServer(const LazyServer&) = delete;
  LazyServer& operator=(const LazyServer&) = delete;
  ~LazyServer() {
    for (const int fd : {connection_, listener_}) close(fd);
  }
  const std::string& url() const { return url_; }
  /// Waits for one client; who came before is left.
  void wait_for_client() {
    close(connection_);
    connection_ = accept(listener_, nullptr, nullptr);
  }
  /// Waits for one client, and says no more to it than that this is LCM's tcpq.
  void greet() {
    wait_for_client();
    const std::array<std::uint32_t, 2> greeting{htonl(0x287617fa), htonl(0x0100)};
    EXPECT_EQ(send(connection_, greeting.data(), sizeof(greeting), 0), static_cast<ssize_t>(sizeof(greeting)));
  }
  void say(const std::string& bytes) const {
    EXPECT_EQ(send(connection_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }

 private:
  int listener_ = socket(AF_INET, SOCK_STREAM, 0), connection_ = -1;
  std::string url_;
};

}  // namespace shaken
