#include "proto/relay/send_queue.h"

#include <utility>

namespace shaken::relay {

void SendQueue::push(Message message) {
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

void SendQueue::sent(std::size_t bytes) {
  sent_ += bytes;
  if (sent_ < messages_.front()->size()) return;
  bytes_ -= messages_.front()->size();
  messages_.pop_front();
  sent_ = 0;
}

}  // namespace shaken::relay
