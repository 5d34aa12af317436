#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

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

}  // namespace shaken::relay
