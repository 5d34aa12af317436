#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "proto/channels.h"
#include "proto/codec.h"

using lcm_t = struct _lcm_t;

namespace shaken::proto {

/// Port and group of LCM's own default, so that plain lcm tools listen to the same; TTL 0 stays on this machine; the
/// receive buffer holds a burst of 2 MB (with the kernel's 212992 bytes one of 300 kB is lost).
inline constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152";

/// LCM_DEFAULT_URL where that is set, kDefaultUrl otherwise.
std::string default_url();

/// What passed through a bus since it was opened.
struct BusCounters {
  std::int64_t published = 0;
  std::int64_t publish_failures = 0;  ///< the network refused them
  std::int64_t received = 0;          ///< decoded and handed to a handler
  std::int64_t refused = 0;           ///< of another type or length than the channel's
  std::int64_t reconnects = 0;        ///< tcpq only
};

/// Publish and subscribe over LCM (liblcm 1.3). Messages may be lost; nobody is told.
///
/// Received payloads are decoded only at their exact length. An exception of a handler does not pass through LCM's C
/// code: it is thrown on from handle(). A tcpq relay that goes away, or does not answer, is waited for with growing
/// pauses; one that takes or gives nothing in the middle of a message is left after kPatience. So no call takes much
/// longer than that.
/// One thread per object: neither publish() nor handle() may run beside another call.
class Bus {
 public:
  /// url: udpm://ADDRESS:PORT?..., tcpq://ADDRESS:PORT (in numbers), memq:// or file://PATH?mode=w|r. An error says
  /// what to do.
  static Result<std::unique_ptr<Bus>> open(const std::string& url = default_url());
  /// For the other end of a tcpq connection.
  static constexpr std::chrono::seconds kPatience{2};
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// False if the message could not be sent; true says nothing about who received it.
  template <class T>
  bool publish(const char* channel, const T& message) {
    return publish_bytes(channel, encode(message));
  }
  /// The same for a payload that is there already, as in a recording.
  bool publish_bytes(const char* channel, std::span<const std::uint8_t> payload);

  /// Calls `handler(const T&)` from handle(). Of messages that wait, the first `queue_capacity` are kept: 1 for a
  /// viewer that wants the newest state soon, more for a recorder or for frames in several chunks.
  /// Returns false if LCM refuses the subscription.
  template <class T, class Handler>
  bool subscribe(const char* channel, Handler handler, int queue_capacity = 30) {
    return subscribe_bytes(channel, queue_capacity,
                           [handler = std::move(handler)](const char*, std::span<const std::uint8_t> payload) mutable {
                             const auto message = decode<T>(payload);
                             if (message) handler(*message);
                             return message.has_value();
                           });
  }

  /// Calls `handler(std::string_view channel, std::span<const std::uint8_t> payload)` with every message as it came, of
  /// the channels that fit `pattern`, a regular expression: for those who hand messages on or keep them. Nothing has
  /// looked at them.
  template <class Handler>
  bool subscribe_raw(const char* pattern, Handler handler, int queue_capacity) {
    return subscribe_bytes(
        pattern, queue_capacity,
        [handler = std::move(handler)](const char* channel, std::span<const std::uint8_t> payload) mutable {
          handler(std::string_view(channel), payload);
          return true;
        });
  }

  /// Waits for at most `timeout_ms` for a message and hands it on. Returns false if none came.
  bool handle(int timeout_ms);
  /// Readable when handle() has something to do, for those who wait for other things too; -1 while not connected.
  int descriptor() const;

  const BusCounters& counters() const { return counters_; }
  const std::string& url() const { return url_; }

 private:
  /// Returns whether the payload could be decoded.
  using Decoder = std::function<bool(const char* channel, std::span<const std::uint8_t>)>;
  struct Subscription {
    Bus* bus;
    std::string channel;
    int queue_capacity;
    Decoder decoder;
  };
  friend struct BusCallback;
  struct Attempt;

  explicit Bus(std::string url) : url_(std::move(url)) {}
  bool subscribe_bytes(const char* channel, int queue_capacity, Decoder decoder);
  bool register_with_lcm(Subscription& subscription);
  void dispatch(Subscription& subscription, const char* channel, std::span<const std::uint8_t> payload) noexcept;
  bool connected() const;
  void connect();
  void reconnect();

  std::string url_;
  std::shared_ptr<Attempt> attempt_;  ///< to connect, which has not come to its end
  lcm_t* lcm_ = nullptr;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  BusCounters counters_;
  std::exception_ptr handler_failure_;
  std::chrono::steady_clock::time_point next_attempt_{};
  std::chrono::milliseconds pause_{0};
};

}  // namespace shaken::proto
