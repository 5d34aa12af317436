#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace shaken {

/// What went wrong, in words for the user: the cause, the value met and the way out.
struct Error {
  std::string message;
  int code = 0;  ///< errno where a call of the system failed; otherwise 0
};

/// A value, or the reason why there is none. True if there is a value.
///
/// For bad input, and for input or output that fails; a broken promise of our own is SHAKEN_CHECK's business. Asking
/// for the value or the reason that is not there throws std::bad_variant_access. `E` is Error, except where there can
/// be several reasons at once (base/keys/problem.h).
template <class T, class E = Error>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(E error) : content_(std::move(error)) {}

  explicit operator bool() const { return std::holds_alternative<T>(content_); }
  T& value() & { return std::get<T>(content_); }
  const T& value() const& { return std::get<T>(content_); }
  T&& value() && { return std::get<T>(std::move(content_)); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const E& error() const { return std::get<E>(content_); }

 private:
  std::variant<T, E> content_;
};

/// That something was done, or the reason why it was not: for functions that give nothing back. True if it was done,
/// as with every Result; `return {};` says so. A failure is passed on, also as one of another type, by
///   SHAKEN_TRY(write_file(file, text));
/// Asking for the reason of a success throws std::bad_optional_access.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}

  explicit operator bool() const { return !error_; }
  void operator*() const {}
  const Error& error() const { return error_.value(); }

 private:
  std::optional<Error> error_;
};

/// The value of a Result; where it has none, the function that this stands in returns the reason.
///   const std::string text = SHAKEN_TRY(read_file(file));
///   SHAKEN_TRY(write_file(copy, text));
#define SHAKEN_TRY(expression)        \
  __extension__({                     \
    auto tried = (expression);        \
    if (!tried) return tried.error(); \
    *std::move(tried);                \
  })

}  // namespace shaken
