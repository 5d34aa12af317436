// What is asked of a Result, or of an optional: its value, or why there is none; and of what has ended: its words.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace shaken::test {

template <class R>
std::string reason_of(const R& result) {
  if constexpr (requires { result.error().message; }) {
    return result.error().message;
  } else if constexpr (requires { result.error(); }) {
    return to_string(result.error());
  } else {
    return "there is nothing";
  }
}

/// What has its value. Where it has none, the test has failed where this was asked, with the reason, and ends.
template <class R>
R good(R result, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (result) return result;
  ADD_FAILURE_AT(file, line) << reason_of(result);
  throw std::logic_error("there is no value");
}

/// Why there is no value. Where there is one, the test has failed where this was asked.
template <class R>
std::string refusal(const R& result, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (!result) return reason_of(result);
  ADD_FAILURE_AT(file, line) << "there is a value";
  return {};
}

/// The exception of this kind that `act` throws. Where it throws none, the test has failed where this was asked, and
/// ends.
template <class Thrown, class Act>
Thrown thrown_by(const Act& act, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  try {
    act();
  } catch (const Thrown& thrown) {
    return thrown;
  }
  ADD_FAILURE_AT(file, line) << "nothing is thrown";
  throw std::logic_error("nothing is thrown");
}

/// What a program, a run, an answer or a Failure says that must end by `code`. Where it ends otherwise, the test has
/// failed where this was asked.
template <class Code, class Ended>
std::string said_with(const Code& code, const Ended& ended, const char* file = __builtin_FILE(),
                      int line = __builtin_LINE()) {
  const auto words_by = [&](const auto& end, const std::string& words) {
    if (end != code) ADD_FAILURE_AT(file, line) << "ended by " << ::testing::PrintToString(end) << ": " << words;
    return words;
  };
  if constexpr (requires { ended.what(); }) {
    return words_by(ended.code, ended.what());
  } else if constexpr (requires { ended.err; }) {
    return words_by(ended.code, ended.err);
  } else if constexpr (requires { ended.output; }) {
    return words_by(ended.code, ended.output);
  } else if constexpr (requires { ended.message; }) {
    return words_by(ended.state, ended.message);
  } else {
    return words_by(ended.status, ended.error());
  }
}

/// The same of one whose words do not matter.
template <class Code, class Ended>
void expect_end(const Code& code, const Ended& ended, const char* file = __builtin_FILE(),
                int line = __builtin_LINE()) {
  said_with(code, ended, file, line);
}

}  // namespace shaken::test
