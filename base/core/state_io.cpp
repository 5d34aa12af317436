#include "base/core/state_io.h"

#include <algorithm>
#include <bit>
#include <string>

namespace shaken {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

namespace {

template <class T>
void put_array(StateWriter& writer, std::span<const T> values) {
  writer.put(static_cast<std::int64_t>(values.size()));
  writer.append(std::as_bytes(values));
}

template <class T>
std::vector<T> of_length(std::vector<T> values, std::size_t length) {
  if (values.size() == length) return values;
  throw StateError("an array of " + std::to_string(values.size()) + " numbers instead of " + std::to_string(length) +
                   "; was it saved with other settings?");
}

}  // namespace

void StateWriter::put(std::span<const double> values) { put_array(*this, values); }
void StateWriter::put(std::span<const std::int64_t> values) { put_array(*this, values); }
void StateWriter::put(std::span<const std::byte> bytes) { put_array(*this, bytes); }

void StateWriter::append(std::span<const std::byte> bytes) {
  size_ += bytes.size();
  if (keeps_) bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void StateReader::tag(std::string_view name) {
  if (!std::ranges::equal(bytes(), std::as_bytes(std::span(name)))) {
    throw StateError("expected '" + std::string(name) + "'");
  }
}

double StateReader::real() {
  double value = 0;
  get(value);
  return value;
}

std::int64_t StateReader::integer() {
  std::int64_t value = 0;
  get(value);
  return value;
}

std::int64_t StateReader::integer(std::int64_t lowest, std::int64_t highest) {
  const std::int64_t value = integer();
  if (value < lowest || value > highest) {
    throw StateError(std::to_string(value) + " is outside [" + std::to_string(lowest) + ", " + std::to_string(highest) +
                     "]");
  }
  return value;
}

std::vector<double> StateReader::reals() { return array<double>(); }
std::vector<std::int64_t> StateReader::integers() { return array<std::int64_t>(); }
std::vector<double> StateReader::reals(std::size_t length) { return of_length(reals(), length); }
std::vector<std::int64_t> StateReader::integers(std::size_t length) { return of_length(integers(), length); }

std::span<const std::byte> StateReader::bytes() { return bytes(length_of(1)); }

std::span<const std::byte> StateReader::bytes(std::size_t size) {
  if (size > rest_.size()) throw StateError("ends too early");
  const std::span<const std::byte> part = rest_.first(size);
  rest_ = rest_.subspan(size);
  return part;
}

void StateReader::end() const {
  if (!rest_.empty()) throw StateError(std::to_string(rest_.size()) + " bytes left over");
}

template <class T>
std::vector<T> StateReader::array() {
  std::vector<T> values(length_of(sizeof(T)));
  fill(std::as_writable_bytes(std::span(values)));
  return values;
}

std::size_t StateReader::length_of(std::size_t element_size) {
  const std::int64_t length = integer();
  // A negative length becomes a huge one.
  if (static_cast<std::uint64_t>(length) > rest_.size() / element_size) {
    throw StateError("an array of " + std::to_string(length) + " numbers is announced, " +
                     std::to_string(rest_.size()) + " bytes are left");
  }
  return static_cast<std::size_t>(length);
}

void StateReader::fill(std::span<std::byte> to) { std::ranges::copy(bytes(to.size()), to.begin()); }

}  // namespace shaken
