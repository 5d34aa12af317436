#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/descriptor.h"
#include "proto/relay/channel_pattern.h"
#include "proto/relay/limits.h"
#include "proto/relay/send_queue.h"
#include "proto/relay/tcpq.h"

namespace shaken::relay {

/// One connected program: its socket, what it has subscribed to and what waits for it. Nothing here waits.
class Client {
 public:
  using Clock = std::chrono::steady_clock;
  using Publish = std::function<void(std::string_view channel, std::string_view payload)>;

  /// A socket that does not block.
  Client(Descriptor socket, const Limits& limits, Clock::time_point now);

  int socket() const { return socket_.value(); }
  /// Reads one piece of what it has sent, unless there is some left of the piece before, and obeys a turn's worth of
  /// it; its messages go to `publish`.
  void receive(const Publish& publish, Clock::time_point now);
  /// Whether there may be something to obey that has been read already.
  bool has_more() const { return has_more_ && !has_ended_; }
  /// Whether it has subscribed to the channel.
  bool wants(std::string_view channel);
  void push(SendQueue::Message message) { queue_.push(std::move(message)); }
  bool has_waiting() const { return !queue_.empty() || !greeting_.empty(); }
  std::size_t n_waiting() const { return queue_.size(); }
  /// Sends what its socket takes.
  void send(Clock::time_point now);
  /// Finds that it has used up the time that it has for something.
  void check_times(Clock::time_point now);

  /// Whether it is to be forgotten: it has gone, or was sent away.
  bool has_ended() const { return has_ended_; }
  /// Why it was sent away; empty if it went by itself.
  const std::string& refusal() const { return refusal_; }
  /// Messages that it did not get because it took others too slowly.
  std::int64_t dropped() const { return queue_.dropped(); }

 private:
  bool read_piece();
  void obey(const Instruction& instruction, const Publish& publish);
  void subscribe(std::string_view pattern);
  void unsubscribe(std::string_view pattern);
  void send_away(std::string refusal);

  Descriptor socket_;
  const Limits& limits_;
  bool is_greeted_ = false;
  bool has_ended_ = false;
  bool has_more_ = false;
  std::string refusal_;
  std::string input_;     ///< not yet a whole instruction
  std::string greeting_;  ///< ours, as far as it has not been sent
  SendQueue queue_;
  std::vector<ChannelPattern> subscriptions_;
  std::unordered_map<std::string, bool> wanted_;  ///< the last channels asked for
  Clock::time_point connected_;
  std::optional<Clock::time_point> incomplete_since_;  ///< the first bytes of `input_`
  std::optional<Clock::time_point> stands_since_;      ///< nothing of what waits has been taken
};

}  // namespace shaken::relay
