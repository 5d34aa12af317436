#include "proto/bus.h"

#include <arpa/inet.h>
#include <lcm/lcm.h>
#include <linux/filter.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace shaken::proto {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kFirstPause{100};
constexpr milliseconds kLongestPause{5000};

constexpr std::string_view kUdpm = "udpm://";
constexpr std::string_view kTcpq = "tcpq://";

constexpr std::uint16_t kDefaultPort = 7667;

/// Lets only messages of one datagram ("LC02") pass to a socket. Those of several ("LC03") are never sent here, and LCM
/// 1.3.1 puts a piece of one wherever its header says: two forged datagrams end the process.
void drop_fragments(int fd) {
  constexpr std::uint32_t kUdpHeader = 8, kShortMessage = 0x4c433032;
  std::array<sock_filter, 4> program{{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kUdpHeader),
                                      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kShortMessage, 0, 1),
                                      BPF_STMT(BPF_RET | BPF_K, UINT32_MAX), BPF_STMT(BPF_RET | BPF_K, 0)}};
  const sock_fprog filter{program.size(), program.data()};
  setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter));
}

/// LCM does not tell the socket on which it receives: it is the one that is bound to the group's port.
void drop_fragments_of(const std::string& url) {
  const std::string target = url.substr(kUdpm.size(), url.find('?') - kUdpm.size());
  const std::size_t colon = target.find(':');
  const long given = colon == std::string::npos ? 0 : std::strtol(target.c_str() + colon + 1, nullptr, 10);
  const std::uint16_t port = given > 0 ? static_cast<std::uint16_t>(given) : kDefaultPort;
  std::error_code ignored;
  // step by step: a range's ++ throws where the system refuses to read on
  for (std::filesystem::directory_iterator entry("/proc/self/fd", ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const int fd = static_cast<int>(std::strtol(entry->path().filename().c_str(), nullptr, 10));
    int type = 0;
    sockaddr_in address{};
    socklen_t type_size = sizeof(type), address_size = sizeof(address);
    if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM) continue;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &address_size) != 0) continue;
    if (address.sin_family == AF_INET && ntohs(address.sin_port) == port) drop_fragments(fd);
  }
}

/// LCM waits without end for a tcpq server's greeting, for room in its buffers, and for the rest of a message.
void give_patience(int fd) {
  const timeval patience{Bus::kPatience.count(), 0};
  setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
}

lcm_t* create(const std::string& url) {
  lcm_t* lcm = lcm_create(url.c_str());
  if (lcm != nullptr && url.starts_with(kTcpq) && lcm_get_fileno(lcm) >= 0) give_patience(lcm_get_fileno(lcm));
  // The first question for its descriptor opens the socket. As long as nothing is subscribed to, LCM takes no pieces.
  if (lcm != nullptr && url.starts_with(kUdpm) && lcm_get_fileno(lcm) >= 0) drop_fragments_of(url);
  return lcm;
}

/// Why udpm cannot start: connects a datagram socket to the group, which sends nothing but needs the same route. LCM
/// does this too, but then prints an uninitialised address to stderr.
Result<void> check_udpm(const std::string& url) {
  const auto group_in = [](const std::string& udpm) {
    const std::string target = udpm.substr(kUdpm.size(), udpm.find('?') - kUdpm.size());
    return target.substr(0, target.find(':'));
  };
  const std::string named = group_in(url), address = named.empty() ? group_in(kDefaultUrl) : named;
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(kDefaultPort);  // any port: only the route counts
  if (inet_aton(address.c_str(), &group.sin_addr) == 0 || !IN_MULTICAST(ntohl(group.sin_addr.s_addr))) {
    return Error{"LCM cannot start: '" + address + "' in '" + url +
                 "' is not a multicast address (224.0.0.0 to 239.255.255.255)"};
  }
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return Error{std::string("LCM cannot start: socket: ") + std::strerror(errno)};
  const bool routed = connect(fd, reinterpret_cast<const sockaddr*>(&group), sizeof(group)) == 0;
  const int reason = errno;
  close(fd);
  if (routed) return {};
  return Error{"LCM cannot start: no multicast route to " + address + " (" + std::strerror(reason) +
               "). As root: ip route add 224.0.0.0/4 dev lo"};
}

/// LCM 1.3.1 takes a name for 0.0.0.0, which is this machine, without a word.
Result<void> check_tcpq(const std::string& url) {
  const std::string target = url.substr(kTcpq.size());
  const std::string address = target.substr(0, target.find(':'));
  in_addr ignored{};
  if (target.empty() || inet_pton(AF_INET, address.c_str(), &ignored) == 1) return {};
  return Error{"LCM cannot start: '" + address + "' in '" + url +
               "' is not an address in four numbers, such as 127.0.0.1"};
}

Result<void> check_url(const std::string& url) {
  if (url.starts_with(kUdpm)) return check_udpm(url);
  if (url.starts_with(kTcpq)) return check_tcpq(url);
  constexpr std::array<std::string_view, 2> kOthers{"memq://", "file://"};
  if (std::any_of(kOthers.begin(), kOthers.end(), [&](auto prefix) { return url.starts_with(prefix); })) {
    return {};
  }
  return Error{"LCM cannot start: '" + url +
               "' is no LCM address; it begins with udpm://, tcpq://, memq:// or file://"};
}

}  // namespace

/// A connection that a thread of its own is making, for that may take for ever. Lives as long as that or the bus does.
struct Bus::Attempt {
  std::mutex mutex;
  std::condition_variable ended;
  bool has_ended = false;
  lcm_t* made = nullptr;  ///< what came of it, until it is taken

  ~Attempt() {
    if (made != nullptr) lcm_destroy(made);
  }
};

/// LCM calls C functions; this one finds its subscription again.
struct BusCallback {
  static void receive(const lcm_recv_buf_t* buffer, const char* channel, void* context) {
    auto& subscription = *static_cast<Bus::Subscription*>(context);
    subscription.bus->dispatch(subscription, channel,
                               {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  }
};

std::string default_url() {
  const char* set = std::getenv("LCM_DEFAULT_URL");
  return set != nullptr && *set != '\0' ? set : kDefaultUrl;
}

Result<std::unique_ptr<Bus>> Bus::open(const std::string& url) {
  SHAKEN_TRY(check_url(url));
  std::unique_ptr<Bus> bus(new Bus(url));
  bus->connect();
  const bool may_come = bus->attempt_ || url.starts_with(kTcpq);
  if (bus->lcm_ == nullptr && !may_come) return Error{"LCM cannot start with '" + url + "'"};
  return bus;
}

Bus::~Bus() {
  if (lcm_ != nullptr) lcm_destroy(lcm_);
}

bool Bus::publish_bytes(const char* channel, std::span<const std::uint8_t> payload) {
  if (!connected()) reconnect();
  const bool sent = connected() && !payload.empty() &&
                    lcm_publish(lcm_, channel, payload.data(), static_cast<unsigned>(payload.size())) == 0;
  ++(sent ? counters_.published : counters_.publish_failures);
  return sent;
}

bool Bus::subscribe_bytes(const char* channel, int queue_capacity, Decoder decoder) {
  subscriptions_.push_back(
      std::make_unique<Subscription>(Subscription{this, channel, queue_capacity, std::move(decoder)}));
  if (!connected() || register_with_lcm(*subscriptions_.back())) return true;  // or when there is a connection
  subscriptions_.pop_back();
  return false;
}

bool Bus::register_with_lcm(Subscription& subscription) {
  lcm_subscription_t* handle = lcm_subscribe(lcm_, subscription.channel.c_str(), &BusCallback::receive, &subscription);
  return handle != nullptr && lcm_subscription_set_queue_capacity(handle, subscription.queue_capacity) == 0;
}

void Bus::dispatch(Subscription& subscription, const char* channel, std::span<const std::uint8_t> payload) noexcept {
  try {
    ++(subscription.decoder(channel, payload) ? counters_.received : counters_.refused);
  } catch (...) {
    handler_failure_ = std::current_exception();
  }
}

bool Bus::handle(int timeout_ms) {
  if (!connected()) {
    reconnect();
    if (!connected()) {
      const auto wait = next_attempt_ - std::chrono::steady_clock::now();
      std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(wait, milliseconds(timeout_ms)));
      return false;
    }
  }
  // lcm_handle_timeout() uses select(), and aborts the process on a closed descriptor or one past 1023.
  pollfd readable{lcm_get_fileno(lcm_), POLLIN, 0};
  if (poll(&readable, 1, timeout_ms) <= 0) return false;
  const bool handled = lcm_handle(lcm_) == 0;
  if (handler_failure_) std::rethrow_exception(std::exchange(handler_failure_, nullptr));
  return handled;
}

int Bus::descriptor() const { return lcm_ != nullptr ? lcm_get_fileno(lcm_) : -1; }

bool Bus::connected() const { return descriptor() >= 0; }

void Bus::connect() {
  if (lcm_ != nullptr) lcm_destroy(std::exchange(lcm_, nullptr));
  if (!url_.starts_with(kTcpq)) {
    lcm_ = create(url_);
    return;
  }
  if (!attempt_) {
    const auto attempt = std::make_shared<Attempt>();
    try {
      std::thread([attempt, url = url_] {
        lcm_t* made = create(url);
        const std::lock_guard lock(attempt->mutex);
        attempt->made = made;
        attempt->has_ended = true;
        attempt->ended.notify_all();
      }).detach();
    } catch (const std::system_error&) {
      return;  // the system has no thread just now: an attempt that came to nothing
    }
    attempt_ = attempt;
  }
  std::unique_lock lock(attempt_->mutex);
  if (!attempt_->ended.wait_for(lock, kPatience, [&] { return attempt_->has_ended; })) return;  // it goes on
  lcm_ = std::exchange(attempt_->made, nullptr);
  lock.unlock();
  attempt_.reset();
}

void Bus::reconnect() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_attempt_) return;
  pause_ = std::clamp(2 * pause_, kFirstPause, kLongestPause);
  connect();
  next_attempt_ = std::chrono::steady_clock::now() + pause_;
  if (!connected()) return;
  for (auto& subscription : subscriptions_) register_with_lcm(*subscription);
  if (!connected()) return;
  ++counters_.reconnects;
  pause_ = milliseconds(0);
}

}  // namespace shaken::proto
