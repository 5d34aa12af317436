#pragma once

#include <cmath>
#include <cstdint>

namespace shaken {

/// A sum that comes out the same, to the last bit, in whatever order its terms are added: each is rounded once, to
/// 2^-kBits of the unit, and then added exactly, in 128 bits. Threads may sum on their own and join later. Terms may be
/// as large as 2^(100 - kBits), and a sum holds 10^8 of those: no scene's come near that.
template <int kBits>
class ExactSum {
 public:
  void add(double term) {
    if (std::abs(term) < kOfOneWord) [[likely]] {
      units_ += std::llrint(term * kPerUnit);
    } else if (std::abs(term) < kLargest) {
      // in two words, the upper one whole: nothing but the last step rounds
      const double units = term * kPerUnit;
      const auto high = static_cast<std::int64_t>(units * 0x1p-48);
      units_ += static_cast<Fixed>(high) * (1LL << 48) + std::llrint(units - static_cast<double>(high) * 0x1p48);
    } else {
      overflow_ = true;
    }
  }
  void add(const ExactSum& more) {
    units_ += more.units_;
    overflow_ = overflow_ || more.overflow_;
  }
  /// NaN if a term was not a number, or too large.
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
  static constexpr double kOfOneWord = static_cast<double>(1LL << (62 - kBits));
  static constexpr double kLargest = kOfOneWord * 0x1p38;

  Fixed units_ = 0;
  bool overflow_ = false;
};

}  // namespace shaken
