#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/core/result.h"
#include "base/descriptor.h"
#include "proto/bus.h"
#include "proto/relay/address.h"
#include "proto/relay/client.h"
#include "proto/relay/limits.h"

namespace shaken::relay {

/// What a relay has counted since it was started.
struct Counters {
  std::atomic<std::int64_t> clients{0};    ///< connected now
  std::atomic<std::int64_t> messages{0};   ///< that came in
  std::atomic<std::int64_t> dropped{0};    ///< not sent to one client that subscribed to them and did not keep up
  std::atomic<std::int64_t> sent_away{0};  ///< clients that did what no client may, or were too many
};

/// Hands LCM messages on where multicast does not reach: the server of LCM's tcpq:// addresses. A message comes from a
/// client, or from the bridged bus, and goes to every client that subscribed to its channel, its sender too; nothing
/// goes back to the bus, so nothing can go round.
///
/// One thread owns the sockets, the clients and the bridged bus, and waits for all of them at once. No client can make
/// it wait: each has its turn after few instructions of another, and patterns that take long are refused. Its callers
/// only read the counters.
class Relay {
 public:
  /// Listens from now on. `bridged` may be null. The error says why it cannot listen.
  static Result<std::unique_ptr<Relay>> start(const Address& address, std::unique_ptr<proto::Bus> bridged,
                                              const Limits& limits = {});
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// With the port that it has got.
  const Address& address() const { return address_; }
  const Counters& counters() const { return counters_; }

 private:
  using Clock = Client::Clock;
  Relay(const Address& address, Descriptor listener, Descriptor waker, std::unique_ptr<proto::Bus> bridged,
        const Limits& limits);
  void serve();
  void run(const std::stop_token& stop);
  void wait();
  void accept_clients();
  void hand_on(std::string_view channel, std::string_view payload);
  void forget_ended();
  /// For the log, once in ten seconds at most: a client that comes again and again must not fill it.
  void warn(const std::string& what);

  Address address_;
  Limits limits_;
  Descriptor listener_;
  Descriptor waker_;  ///< an eventfd
  std::unique_ptr<proto::Bus> bridged_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::vector<bool> is_readable_;  ///< which of them
  bool is_asked_to_accept_ = false;
  Clock::time_point accepts_from_{};  ///< there was no descriptor for a client before
  Clock::time_point warns_from_{};
  std::int64_t kept_back_ = 0;  ///< warnings until then
  Counters counters_;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace shaken::relay
