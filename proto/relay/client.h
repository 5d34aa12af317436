#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/core/result.h"
#include "base/descriptor.h"
#include "proto/relay/limits.h"
#include "proto/relay/tcpq.h"

namespace re2 {
class RE2;
}

namespace shaken::relay {

/// What waits to be sent to one client. Messages are shared with the queues of others. Where there are too many, or too
/// many bytes of them, the oldest go; only the one of which a part has been sent already stays, for it must be whole.
class SendQueue {
 public:
  using Message = std::shared_ptr<const std::string>;

  SendQueue(std::size_t most_messages, std::size_t most_bytes)
      : most_messages_(most_messages), most_bytes_(most_bytes) {}

  void push(Message message) {
    bytes_ += message->size();
    messages_.push_back(std::move(message));
    const std::size_t kept = sent_ > 0 ? 1 : 0;
    while (messages_.size() > kept && (messages_.size() - kept > most_messages_ || bytes_ > most_bytes_)) {
      const auto oldest = messages_.begin() + static_cast<std::ptrdiff_t>(kept);
      bytes_ -= (*oldest)->size();
      messages_.erase(oldest);
      ++dropped_;
    }
  }
  bool empty() const { return messages_.empty(); }
  std::size_t size() const { return messages_.size(); }
  /// The bytes to be sent next: what is left of the first message.
  std::string_view next() const { return std::string_view(*messages_.front()).substr(sent_); }
  /// So many of these have been sent.
  void sent(std::size_t bytes) {
    sent_ += bytes;
    if (sent_ < messages_.front()->size()) return;
    bytes_ -= messages_.front()->size();
    messages_.pop_front();
    sent_ = 0;
  }
  std::int64_t dropped() const { return dropped_; }

 private:
  std::size_t most_messages_, most_bytes_;
  std::deque<Message> messages_;
  std::size_t bytes_ = 0;  ///< of all messages, whether sent in part or not
  std::size_t sent_ = 0;   ///< of the first message
  std::int64_t dropped_ = 0;
};

/// What a client subscribes to: a regular expression that fits a channel as LCM itself has it, that is `^PATTERN$`.
///
/// LCM matches with PCRE, whose time can grow as fast as 2 to the channel's length, and the pattern is a stranger's.
/// RE2 takes time in proportion to both lengths, and a bounded memory; it knows no back-references and no assertions
/// about what stands around, so patterns with these are refused, and its classes such as \w are ASCII.
class ChannelPattern {
 public:
  /// An error says what is wrong with the pattern.
  static Result<ChannelPattern> compile(std::string_view pattern);
  ChannelPattern(ChannelPattern&&) noexcept;
  ChannelPattern& operator=(ChannelPattern&&) noexcept;
  ~ChannelPattern();

  bool matches(std::string_view channel) const;
  const std::string& text() const { return text_; }
  /// Instructions of the compiled pattern: a match takes time in proportion to that and to the channel's length.
  std::size_t size() const;

 private:
  ChannelPattern(std::string text, std::unique_ptr<re2::RE2> expression);
  std::string text_;
  std::unique_ptr<re2::RE2> expression_;
};

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
