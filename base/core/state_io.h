#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/types.h"

namespace shaken {

/// Saved bytes that are too short, too long, or not of the object that reads them.
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Numbers that are saved as they are; a bool has no size that all machines agree on.
template <class T>
concept SavedNumber = (std::integral<T> || std::floating_point<T>)&&!std::same_as<T, bool>;

/// Appends numbers and arrays to bytes, exactly and little-endian: all that checkpoints are made of. Guarding the bytes
/// against rot is the business of who writes them into a file.
class StateWriter {
 public:
  StateWriter() = default;
  /// With room for that many bytes, so that a large state is never moved while it is gathered.
  explicit StateWriter(std::size_t size) { bytes_.reserve(size); }
  /// One that keeps nothing and only counts, to learn that size.
  static StateWriter counting() {
    StateWriter writer;
    writer.keeps_ = false;
    return writer;
  }

  /// Opens the part of one object, so that a reader out of step finds out at once.
  void tag(std::string_view name) { put(std::as_bytes(std::span(name))); }
  /// A number of as many bytes as its type has.
  template <SavedNumber T>
  void put(T value) {
    append(std::as_bytes(std::span(&value, 1)));
  }
  void put(const Vec3& v) { append(std::as_bytes(std::span(v.data(), 3))); }
  /// Arrays, behind their lengths (64 bits).
  void put(std::span<const double> values);
  void put(std::span<const std::int64_t> values);
  void put(std::span<const std::byte> bytes);
  /// Bytes without their length.
  void append(std::span<const std::byte> bytes);

  const std::vector<std::byte>& bytes() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }
  /// Bytes written so far.
  std::size_t size() const { return size_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t size_ = 0;
  bool keeps_ = true;
};

/// Reads what StateWriter wrote, in the same order. Every call throws StateError if the bytes do not hold what is
/// asked for; no length in the bytes is trusted before it is checked against what is left of them.
class StateReader {
 public:
  explicit StateReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  void tag(std::string_view name);
  template <SavedNumber T>
  void get(T& value) {
    fill(std::as_writable_bytes(std::span(&value, 1)));
  }
  void get(Vec3& v) { fill(std::as_writable_bytes(std::span(v.data(), 3))); }
  double real();
  std::int64_t integer();
  /// A count or an index: throws if it is outside [lowest, highest].
  std::int64_t integer(std::int64_t lowest, std::int64_t highest);
  std::size_t length_of(std::size_t element_size);  ///< of what follows, which has so many elements if nothing throws
  std::vector<double> reals();
  std::vector<std::int64_t> integers();
  /// Arrays whose length is known; throw if the stored one differs.
  std::vector<double> reals(std::size_t length);
  std::vector<std::int64_t> integers(std::size_t length);
  /// Bytes behind their length, and a number of bytes; a part of those that are read, not a copy.
  std::span<const std::byte> bytes();
  std::span<const std::byte> bytes(std::size_t size);
  /// Throws unless everything has been read.
  void end() const;

 private:
  template <class T>
  std::vector<T> array();
  void fill(std::span<std::byte> to);
  std::span<const std::byte> rest_;
};

}  // namespace shaken
