#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "base/core/result.h"

namespace shaken {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor() {
    if (value_ >= 0) close(value_);
  }
  int value() const { return value_; }
  /// Closes now, and says with errno whether that failed: network disks report lost writes only here.
  bool close_now() { return close(std::exchange(value_, -1)) == 0; }
  explicit operator bool() const { return value_ >= 0; }

 private:
  int value_;
};

/// `what`, and the system's reason for the last call that failed.
inline Error system_error(const std::string& what) {
  const int code = errno;
  return {what + ": " + std::strerror(code), code};
}

}  // namespace shaken
