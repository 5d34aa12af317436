#include "proto/relay/relay.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <thread>
#include <utility>

namespace shaken::relay {
namespace {

using std::chrono::milliseconds;

/// Between looks at the clients' times.
constexpr milliseconds kRound{1000};
/// After a round that failed for want of memory.
constexpr milliseconds kBreath{10};
/// Where there is no descriptor for another client.
constexpr milliseconds kPauseOfAccepting{500};
/// Messages of the bridged bus in one go, before the clients have their turn again.
constexpr int kBridgedAtOnce = 20;
/// Messages that LCM keeps of the bridged bus until then.
constexpr int kBridgeCapacity = 1000;
/// So many may wait for a client before its socket is tried even though others are still being read.
constexpr std::size_t kSoonSent = 32;
/// What the system keeps for a client: more would only make old what a slow one sees.
constexpr int kSystemBuffer = 512 << 10;

void set(int socket, int level, int option, int value) { setsockopt(socket, level, option, &value, sizeof(value)); }

sockaddr_in system_address(const Address& address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(address.port);
  result.sin_addr.s_addr = htonl(address.host);
  return result;
}

/// Listens, and puts the port that it has got into `address`.
Result<Descriptor> listen_at(Address& address) {
  constexpr int kBacklog = 64;
  Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!listener) return system_error("the relay cannot listen: socket");
  set(listener.value(), SOL_SOCKET, SO_REUSEADDR, 1);
  sockaddr_in where = system_address(address);
  socklen_t size = sizeof(where);
  if (bind(listener.value(), reinterpret_cast<const sockaddr*>(&where), size) != 0 ||
      listen(listener.value(), kBacklog) != 0 ||
      getsockname(listener.value(), reinterpret_cast<sockaddr*>(&where), &size) != 0) {
    return system_error("the relay cannot listen at " + address.text());
  }
  address.port = ntohs(where.sin_port);
  return listener;
}

/// A client of another machine that has vanished without a word is noticed after about two minutes.
void prepare(int client) {
  set(client, IPPROTO_TCP, TCP_NODELAY, 1);
  set(client, SOL_SOCKET, SO_SNDBUF, kSystemBuffer);
  set(client, SOL_SOCKET, SO_KEEPALIVE, 1);
  set(client, IPPROTO_TCP, TCP_KEEPIDLE, 60);
  set(client, IPPROTO_TCP, TCP_KEEPINTVL, 15);
  set(client, IPPROTO_TCP, TCP_KEEPCNT, 4);
}

}  // namespace

Result<std::unique_ptr<Relay>> Relay::start(const Address& address, std::unique_ptr<proto::Bus> bridged,
                                            const Limits& limits) {
  Address got = address;
  auto listener = SHAKEN_TRY(listen_at(got));
  Descriptor waker(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!waker) return system_error("the relay cannot start: eventfd");
  return std::unique_ptr<Relay>(new Relay(got, std::move(listener), std::move(waker), std::move(bridged), limits));
}

Relay::Relay(const Address& address, Descriptor listener, Descriptor waker, std::unique_ptr<proto::Bus> bridged,
             const Limits& limits)
    : address_(address),
      limits_(limits),
      listener_(std::move(listener)),
      waker_(std::move(waker)),
      bridged_(std::move(bridged)) {
  if (bridged_) {
    bridged_->subscribe_raw(
        ".*",
        [this](std::string_view channel, std::span<const std::uint8_t> payload) {
          hand_on(channel, {reinterpret_cast<const char*>(payload.data()), payload.size()});
        },
        kBridgeCapacity);
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Relay::~Relay() {
  thread_.request_stop();
  eventfd_write(waker_.value(), 1);
}

void Relay::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    try {
      wait();
      serve();
    } catch (const std::exception&) {  // no memory: messages are lost, as they may be, and nothing else
      std::this_thread::sleep_for(kBreath);
    }
  }
}

void Relay::serve() {
  const Clock::time_point now = Clock::now();
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    if (!is_readable_[i]) continue;
    clients_[i]->receive([this](std::string_view channel, std::string_view payload) { hand_on(channel, payload); },
                         now);
    // LCM's client sends a message in five pieces, and its system each only when we have acknowledged the last one:
    // an acknowledgement that waits, as is usual, costs 40 ms.
    set(clients_[i]->socket(), IPPROTO_TCP, TCP_QUICKACK, 1);
  }
  for (int i = 0; bridged_ && i < kBridgedAtOnce && bridged_->handle(0); ++i) {
  }
  for (const auto& client : clients_) {
    client->send(now);
    client->check_times(now);
  }
  forget_ended();
  if (is_asked_to_accept_) accept_clients();
}

void Relay::wait() {
  const bool accepts = Clock::now() >= accepts_from_;
  std::vector<pollfd> sources{{waker_.value(), POLLIN, 0},
                              {accepts ? listener_.value() : -1, POLLIN, 0},
                              {bridged_ ? bridged_->descriptor() : -1, POLLIN, 0}};
  const std::size_t n_own = sources.size();
  sources.reserve(n_own + clients_.size());
  for (const auto& client : clients_) {
    const int events = POLLIN | (client->has_waiting() ? POLLOUT : 0);
    sources.push_back({client->socket(), static_cast<short>(events), 0});
  }
  const bool is_busy =
      std::any_of(clients_.begin(), clients_.end(), [](const auto& client) { return client->has_more(); });
  const milliseconds longest = is_busy ? milliseconds(0) : accepts ? kRound : kPauseOfAccepting;
  if (poll(sources.data(), sources.size(), static_cast<int>(longest.count())) < 0) {
    for (pollfd& source : sources) source.revents = 0;
  }
  is_asked_to_accept_ = sources[1].revents != 0;
  is_readable_.assign(clients_.size(), false);
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    is_readable_[i] = clients_[i]->has_more() || (sources[n_own + i].revents & (POLLIN | POLLHUP | POLLERR)) != 0;
  }
}

void Relay::accept_clients() {
  for (;;) {
    const Clock::time_point now = Clock::now();
    Descriptor socket(accept4(listener_.value(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket) {
      if (errno == ECONNABORTED || errno == EINTR) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK) {
        accepts_from_ = now + kPauseOfAccepting;
        warn(system_error("no client can be taken").message);
      }
      return;
    }
    if (clients_.size() >= limits_.clients) {
      // Closed rather than left to wait: LCM's client waits for an answer for ever, but goes on if there is none.
      ++counters_.sent_away;
      warn("a client was sent away: " + std::to_string(limits_.clients) + " are connected");
      continue;
    }
    prepare(socket.value());
    clients_.push_back(std::make_unique<Client>(std::move(socket), limits_, now));
    counters_.clients = static_cast<std::int64_t>(clients_.size());
  }
}

void Relay::hand_on(std::string_view channel, std::string_view payload) {
  ++counters_.messages;
  SendQueue::Message message;
  for (const auto& client : clients_) {
    if (!client->wants(channel)) continue;
    if (!message) message = std::make_shared<const std::string>(publication(channel, payload));
    const std::int64_t dropped_before = client->dropped();
    client->push(message);
    // Those who keep up must not lose anything because many messages came at once.
    if (client->n_waiting() >= kSoonSent || message->size() > limits_.waiting_bytes / kSoonSent) {
      client->send(Clock::now());
    }
    if (const std::int64_t dropped = client->dropped() - dropped_before; dropped > 0) {
      if (dropped_before == 0) warn("a client does not keep up, and misses messages");
      counters_.dropped += dropped;
    }
  }
}

void Relay::forget_ended() {
  const auto has_ended = [this](const std::unique_ptr<Client>& client) {
    if (!client->has_ended()) return false;
    if (!client->refusal().empty()) {
      ++counters_.sent_away;
      warn("a client was sent away: " + client->refusal());
    }
    return true;
  };
  std::erase_if(clients_, has_ended);
  counters_.clients = static_cast<std::int64_t>(clients_.size());
}

void Relay::warn(const std::string& what) {
  constexpr std::chrono::seconds kPause{10};
  const Clock::time_point now = Clock::now();
  if (now < warns_from_) {
    ++kept_back_;
    return;
  }
  warns_from_ = now + kPause;
  const std::int64_t others = std::exchange(kept_back_, 0);
  spdlog::warn("relay: {}{}", what,
               others > 0 ? "; " + std::to_string(others) + " such warnings were left out before" : "");
}

}  // namespace shaken::relay
