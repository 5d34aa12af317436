// SPDX-License-Identifier: MIT
#include "analysis/state_io.h"

#include <cstring>
#include <string>

namespace shaken::analysis {

void StateWriter::tag(std::string_view name) {
  put(static_cast<std::int64_t>(name.size()));
  append(name.data(), name.size());
}

void StateWriter::put(double value) { append(&value, sizeof value); }

void StateWriter::put(std::int64_t value) { append(&value, sizeof value); }

void StateWriter::put(std::span<const double> values) {
  put(static_cast<std::int64_t>(values.size()));
  append(values.data(), values.size_bytes());
}

void StateWriter::put(std::span<const std::int64_t> values) {
  put(static_cast<std::int64_t>(values.size()));
  append(values.data(), values.size_bytes());
}

void StateWriter::append(const void* data, std::size_t size) {
  const auto* first = static_cast<const std::byte*>(data);
  bytes_.insert(bytes_.end(), first, first + size);
}

void StateReader::tag(std::string_view name) {
  std::string found(length_of(1), '\0');
  take(found.data(), found.size());
  if (found != name) throw StateError("saved analysis state: expected '" + std::string(name) + "'");
}

double StateReader::real() {
  double value = 0;
  take(&value, sizeof value);
  return value;
}

std::int64_t StateReader::integer() {
  std::int64_t value = 0;
  take(&value, sizeof value);
  return value;
}

std::int64_t StateReader::integer(std::int64_t lowest, std::int64_t highest) {
  const std::int64_t value = integer();
  if (value < lowest || value > highest) {
    throw StateError("saved analysis state: " + std::to_string(value) + " is outside [" + std::to_string(lowest) +
                     ", " + std::to_string(highest) + "]");
  }
  return value;
}

std::vector<double> StateReader::reals() {
  std::vector<double> values(length_of(sizeof(double)));
  take(values.data(), values.size() * sizeof(double));
  return values;
}

std::vector<std::int64_t> StateReader::integers() {
  std::vector<std::int64_t> values(length_of(sizeof(std::int64_t)));
  take(values.data(), values.size() * sizeof(std::int64_t));
  return values;
}

namespace {

template <class T>
std::vector<T> of_length(std::vector<T> values, std::size_t length) {
  if (values.size() == length) return values;
  throw StateError("saved analysis state: an array of " + std::to_string(values.size()) + " numbers instead of " +
                   std::to_string(length) + "; was it saved with other settings?");
}

}  // namespace

std::vector<double> StateReader::reals(std::size_t length) { return of_length(reals(), length); }

std::vector<std::int64_t> StateReader::integers(std::size_t length) { return of_length(integers(), length); }

void StateReader::end() const {
  if (!rest_.empty()) throw StateError("saved analysis state: " + std::to_string(rest_.size()) + " bytes left over");
}

std::size_t StateReader::length_of(std::size_t element_size) {
  const std::int64_t length = integer();
  // A negative length becomes a huge one.
  if (static_cast<std::uint64_t>(length) > rest_.size() / element_size) {
    throw StateError("saved analysis state: an array of " + std::to_string(length) + " numbers is announced, " +
                     std::to_string(rest_.size()) + " bytes are left");
  }
  return static_cast<std::size_t>(length);
}

void StateReader::take(void* data, std::size_t size) {
  if (size > rest_.size()) throw StateError("saved analysis state: ends too early");
  if (size == 0) return;  // memcpy wants real addresses even then
  std::memcpy(data, rest_.data(), size);
  rest_ = rest_.subspan(size);
}

}  // namespace shaken::analysis
