#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/core/result.h"

namespace re2 {
class RE2;
}

namespace shaken::relay {

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

}  // namespace shaken::relay
