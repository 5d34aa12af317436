#include "proto/relay/client.h"

#include <re2/re2.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "base/text.h"

namespace shaken::relay {
namespace {

/// Read in one go: small enough that a client that floods the others leaves these time to take what it sends.
constexpr std::size_t kPiece = 64 << 10;
/// Channels of which is remembered whether they are wanted.
constexpr std::size_t kRemembered = 256;

/// For a compiled pattern and for what is remembered while matching; a pattern that needs more is refused.
constexpr std::int64_t kMemory = 64 << 10;

bool is_to_be_tried_again() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

Result<ChannelPattern> ChannelPattern::compile(std::string_view pattern) {
  re2::RE2::Options options;
  options.set_log_errors(false);
  options.set_max_mem(kMemory);
  options.set_never_capture(true);
  std::string text(pattern);
  auto expression = std::make_unique<re2::RE2>("^" + text + "$", options);
  if (!expression->ok()) return Error{expression->error()};
  return ChannelPattern(std::move(text), std::move(expression));
}

ChannelPattern::ChannelPattern(std::string text, std::unique_ptr<re2::RE2> expression)
    : text_(std::move(text)), expression_(std::move(expression)) {}
ChannelPattern::ChannelPattern(ChannelPattern&&) noexcept = default;
ChannelPattern& ChannelPattern::operator=(ChannelPattern&&) noexcept = default;
ChannelPattern::~ChannelPattern() = default;

std::size_t ChannelPattern::size() const { return static_cast<std::size_t>(expression_->ProgramSize()); }

bool ChannelPattern::matches(std::string_view channel) const {
  return re2::RE2::PartialMatch(re2::StringPiece(channel.data(), channel.size()), *expression_);
}

Client::Client(Descriptor socket, const Limits& limits, Clock::time_point now)
    : socket_(std::move(socket)),
      limits_(limits),
      queue_(limits.waiting_messages, limits.waiting_bytes),
      connected_(now) {}

bool Client::read_piece() {
  std::array<char, kPiece> piece;
  const ssize_t n = recv(socket(), piece.data(), piece.size(), 0);
  if (n < 0 && is_to_be_tried_again()) return false;
  has_ended_ = n <= 0;
  if (!has_ended_) input_.append(piece.data(), static_cast<std::size_t>(n));
  return !has_ended_;
}

void Client::receive(const Publish& publish, Clock::time_point now) {
  if (has_ended_ || (!has_more_ && !read_piece())) return;
  std::size_t used = 0;
  if (!is_greeted_) {
    const Greeting greeting = greeting_of(input_);
    if (greeting == Greeting::kWrong) send_away("it does not speak LCM's tcpq");
    if (greeting != Greeting::kRight) return;
    is_greeted_ = true;
    greeting_ = server_greeting();
    used = kGreetingBytes;
  }
  has_more_ = true;
  for (std::size_t n = 0; n < limits_.turn && has_more_ && !has_ended_; ++n) {
    const Parsed parsed = parse_instruction(std::string_view(input_).substr(used), limits_);
    if (const auto* unreadable = std::get_if<Unreadable>(&parsed)) send_away("it sent " + unreadable->reason);
    const auto* instruction = std::get_if<Instruction>(&parsed);
    has_more_ = instruction != nullptr;
    if (!has_more_) break;
    obey(*instruction, publish);
    used += instruction->size;
  }
  input_.erase(0, used);
  if (input_.empty() || has_more_) {
    incomplete_since_.reset();
  } else if (used > 0 || !incomplete_since_) {
    incomplete_since_ = now;
  }
}

void Client::obey(const Instruction& instruction, const Publish& publish) {
  switch (instruction.kind) {
    case Kind::kPublish:
      return publish(instruction.text, instruction.payload);
    case Kind::kSubscribe:
      return subscribe(instruction.text);
    case Kind::kUnsubscribe:
      return unsubscribe(instruction.text);
  }
}

void Client::subscribe(std::string_view pattern) {
  if (subscriptions_.size() >= limits_.subscriptions) {
    return send_away("it has more than " + std::to_string(limits_.subscriptions) + " subscriptions");
  }
  auto compiled = ChannelPattern::compile(pattern);
  // tcpq has no answer that says so, and a subscriber that waits for ever would not learn why.
  if (!compiled) return send_away("its subscription cannot be used: " + printable(compiled.error().message));
  std::size_t size = compiled->size();
  for (const ChannelPattern& other : subscriptions_) size += other.size();
  if (size > limits_.program) return send_away("its subscriptions take too long to match: " + printable(pattern));
  subscriptions_.push_back(std::move(compiled).value());
  wanted_.clear();
}

void Client::unsubscribe(std::string_view pattern) {
  const auto same = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                 [&](const ChannelPattern& subscription) { return subscription.text() == pattern; });
  if (same != subscriptions_.end()) subscriptions_.erase(same);
  wanted_.clear();
}

bool Client::wants(std::string_view channel) {
  if (has_ended_ || subscriptions_.empty()) return false;
  std::string name(channel);
  if (const auto known = wanted_.find(name); known != wanted_.end()) return known->second;
  const bool is_wanted = std::any_of(subscriptions_.begin(), subscriptions_.end(),
                                     [&](const ChannelPattern& pattern) { return pattern.matches(channel); });
  if (wanted_.size() >= kRemembered) wanted_.clear();
  wanted_.emplace(std::move(name), is_wanted);
  return is_wanted;
}

void Client::send(Clock::time_point now) {
  while (!has_ended_ && has_waiting()) {
    const std::string_view bytes = greeting_.empty() ? queue_.next() : std::string_view(greeting_);
    const ssize_t n = ::send(socket(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n < 0) {
      if (!is_to_be_tried_again()) {
        has_ended_ = true;
      } else if (!stands_since_) {
        stands_since_ = now;
      }
      return;
    }
    if (greeting_.empty()) {
      queue_.sent(static_cast<std::size_t>(n));
    } else {
      greeting_.erase(0, static_cast<std::size_t>(n));
    }
    stands_since_.reset();
  }
}

void Client::check_times(Clock::time_point now) {
  if (has_ended_) return;
  if (!is_greeted_ && now - connected_ > limits_.greeting) return send_away("it said nothing");
  if (incomplete_since_ && now - *incomplete_since_ > limits_.message) return send_away("it sent half a message");
  if (stands_since_ && now - *stands_since_ > limits_.standstill) {
    return send_away("it took nothing for " + std::to_string(limits_.standstill.count()) + " s");
  }
}

void Client::send_away(std::string refusal) {
  has_ended_ = true;
  refusal_ = std::move(refusal);
}

}  // namespace shaken::relay
