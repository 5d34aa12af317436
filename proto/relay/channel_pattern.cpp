#include "proto/relay/channel_pattern.h"

#include <re2/re2.h>

#include <utility>

namespace shaken::relay {
namespace {

/// For the compiled pattern and for what is remembered while matching; a pattern that needs more is refused.
constexpr std::int64_t kMemory = 64 << 10;

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

}  // namespace shaken::relay
