// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

namespace shaken {

/// A sum that comes out the same, to the last bit, in whatever order its terms are added: each is rounded once, to
/// 2^-kBits of the unit, and then added exactly, in 128 bits. Threads may sum on their own and join later. Terms may be
/// as large as 2^(110 - kBits), and a sum as large as 2^(126 - kBits): no scene's come near that.
template <int kBits>
class ExactSum {
 public:
  void add(double term) {
    const double scaled = term * kPerUnit;
    if (std::abs(scaled) < kOfOneWord) {
      units_ += std::llrint(scaled);
    } else {
      add_large(scaled);
    }
  }
  void add(const ExactSum& more) {
    units_ += more.units_;
    overflow_ = overflow_ || more.overflow_;
  }
  /// NaN if a term was not a number, or it or the sum was too large.
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
  static constexpr double kPerUnit = static_cast<double>(1LL << kBits);
  static constexpr double kOfOneWord = 0x1p62;
  static constexpr double kLargestTerm = 0x1p110;
  static constexpr Fixed kLargestSum = static_cast<Fixed>(1) << 126;

  /// Doubles as large as this are whole numbers: nothing is left to round.
  [[gnu::noinline]] void add_large(double scaled) {
    if (std::abs(scaled) < kLargestTerm) units_ += static_cast<Fixed>(scaled);
    const bool fits = std::abs(scaled) < kLargestTerm && units_ < kLargestSum && units_ > -kLargestSum;
    overflow_ = overflow_ || !fits;
  }
  Fixed units_ = 0;
  bool overflow_ = false;
};

}  // namespace shaken
