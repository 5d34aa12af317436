// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace shaken::analysis {

/// Saved bytes that are too short, too long, or not of the object that reads them.
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Appends numbers and arrays to bytes, exactly, in the byte order of the machine: the part of a checkpoint that the
/// accumulators own. Guarding the bytes against rot is the checkpoint's business.
class StateWriter {
 public:
  /// Opens the part of one object, so that a reader out of step finds out at once.
  void tag(std::string_view name);
  void put(double value);
  void put(std::int64_t value);
  void put(std::span<const double> values);
  void put(std::span<const std::int64_t> values);

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size);
  std::vector<std::byte> bytes_;
};

/// Reads what StateWriter wrote, in the same order. Every call throws StateError if the bytes do not hold what is
/// asked for; no length in the bytes is trusted before it is checked against what is left of them.
class StateReader {
 public:
  explicit StateReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  void tag(std::string_view name);
  double real();
  std::int64_t integer();
  /// A count or an index: throws if it is outside [lowest, highest].
  std::int64_t integer(std::int64_t lowest, std::int64_t highest);
  std::vector<double> reals();
  std::vector<std::int64_t> integers();
  /// Arrays whose length is known; throw if the stored one differs.
  std::vector<double> reals(std::size_t length);
  std::vector<std::int64_t> integers(std::size_t length);
  /// Throws unless everything has been read.
  void end() const;

 private:
  std::size_t length_of(std::size_t element_size);
  void take(void* data, std::size_t size);
  std::span<const std::byte> rest_;
};

}  // namespace shaken::analysis
