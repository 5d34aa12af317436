// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

namespace shaken {

/// A sum that comes out the same, to the last bit, in whatever order its terms are added: each is rounded once, to
/// 2^-32 of the unit, and then added exactly, in 128 bits. Threads may sum on their own and join later.
class ExactSum {
 public:
  void add(double term) {
    if (std::abs(term) < kLargest) {
      units_ += std::llrint(term * kPerUnit);
    } else {
      overflow_ = true;
    }
  }
  void add(const ExactSum& more) {
    units_ += more.units_;
    overflow_ = overflow_ || more.overflow_;
  }
  /// NaN if a term was not a number or beyond 2^30.
  double value() const { return overflow_ ? NAN : static_cast<double>(units_) / kPerUnit; }

  // for checkpoints
  std::uint64_t low() const { return static_cast<std::uint64_t>(units_); }
  std::int64_t high() const { return static_cast<std::int64_t>(units_ >> 64); }
  bool overflow() const { return overflow_; }
  void restore(std::uint64_t low, std::int64_t high, bool overflow) {
    units_ = static_cast<Fixed>((static_cast<UnsignedFixed>(static_cast<std::uint64_t>(high)) << 64) | low);
    overflow_ = overflow;
  }

 private:
  __extension__ using Fixed = __int128;
  __extension__ using UnsignedFixed = unsigned __int128;
  static constexpr double kPerUnit = 4294967296.0;
  static constexpr double kLargest = 1073741824.0;
  Fixed units_ = 0;
  bool overflow_ = false;
};

}  // namespace shaken
