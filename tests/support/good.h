// What is asked of a Result, or of an optional: its value, or why there is none.
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

}  // namespace shaken::test
