#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/box.h"
#include "base/core/state_io.h"
#include "base/core/types.h"

namespace shaken::analysis {

/// No run counts farther; what is made of counts (sums over stretches, means) then neither overflows nor loses digits.
inline constexpr std::int64_t kMostCounted = std::int64_t{1} << 53;

/// A field that is the same in all that are merged and in a state that is restored: a setting, or what follows from it.
template <class T>
struct Setting {
  const char* what;  ///< "range": for the message where it differs
  T value;
};
/// A field of which the larger value holds when two are merged: what others have taken before.
template <class T>
struct Largest {
  T& value;
};
/// An index, or -1.
template <class T>
struct IndexOrNone {
  T& value;
};
/// Vectors of numbers, and arrays of such vectors, of one length that only the state knows.
template <class... Vectors>
struct Growing {
  explicit Growing(Vectors&... of) : vectors(of...) {}
  std::tuple<Vectors&...> vectors;
};
/// The length of a vector that is a later field, its elements being read into copies of `empty`.
template <class Vector>
struct Length {
  Vector& vector;
  typename Vector::value_type empty = {};
  std::size_t numbers = 1;  ///< that each element counts for
};
/// Fields (listed) that are there only where a condition, which an earlier field may be, does not hold.
template <class Condition, class Fields>
struct Unless {
  Condition condition;
  Fields fields;
};

template <class T>
Setting(const char*, T&&) -> Setting<T>;
template <class T>
Largest(T&) -> Largest<T>;
template <class T>
IndexOrNone(T&) -> IndexOrNone<T>;
template <class Vector, class... Rest>
Length(Vector&, Rest...) -> Length<Vector>;
template <class Condition, class Fields>
Unless(Condition&&, Fields) -> Unless<Condition, Fields>;

/// The fields of an object, of which `fields` gives a reference each, or one of the above.
template <class... Fields>
auto listed(Fields&&... fields) {
  return std::tuple<Fields...>(std::forward<Fields>(fields)...);
}

/// What writes and reads fields of any type.
struct SavedFields {
  template <class... Fields>
  static void put(StateWriter& writer, const std::tuple<Fields...>& fields) {
    std::apply([&](const auto&... field) { (put(writer, field), ...); }, fields);
  }
  template <class T>
  static void put(StateWriter& writer, const T& value) {
    if constexpr (requires { value.save(writer); }) {
      value.save(writer);
    } else if constexpr (requires { value.fields(value); }) {
      put(writer, value.fields(value));
    } else if constexpr (requires { value.value; }) {
      put(writer, value.value);
    } else if constexpr (std::integral<T>) {
      writer.put(static_cast<std::int64_t>(value));
    } else if constexpr (std::is_same_v<T, Vec2>) {
      writer.put(value.x());
      writer.put(value.y());
    } else if constexpr (std::is_same_v<T, Box>) {  // of a square one number
      writer.put(value.x());
      if (value.y() != value.x()) writer.put(value.y());
    } else if constexpr (requires { writer.put(value); }) {
      writer.put(value);
    } else {
      for (const auto& element : value) put(writer, element);
    }
  }
  template <class... Vectors>
  static void put(StateWriter& writer, const Growing<Vectors...>& growing) {
    put(writer, growing.vectors);
  }
  template <class Vector>
  static void put(StateWriter& writer, const Length<Vector>& length) {
    put(writer, length.numbers * length.vector.size());
  }
  template <class Condition, class Fields>
  static void put(StateWriter& writer, const Unless<Condition, Fields>& unless) {
    if (!unless.condition) put(writer, unless.fields);
  }

  template <class... Fields>
  static void take(StateReader& reader, std::tuple<Fields...> fields) {
    std::apply([&](auto&... field) { (take(reader, field), ...); }, fields);
  }
  template <class Object>
  static void take_fields(StateReader& reader, Object& object) {
    take(reader, object.fields(object));
    if constexpr (requires { object.is_sound(); }) {
      if (!object.is_sound()) throw StateError("numbers that do not belong together");
    }
  }
  template <class T>
  static void take(StateReader& reader, T& value) {
    if constexpr (requires { value.restore(reader); }) {
      value.restore(reader);
    } else if constexpr (requires { value.fields(value); }) {
      take_fields(reader, value);
    } else if constexpr (requires { value.value; }) {
      take(reader, value.value);
    } else if constexpr (std::is_same_v<T, double>) {
      value = reader.real();
    } else if constexpr (std::integral<T>) {
      constexpr std::uint64_t most = std::min<std::uint64_t>(kMostCounted, std::numeric_limits<T>::max());
      value = static_cast<T>(reader.integer(0, static_cast<std::int64_t>(most)));
    } else if constexpr (std::is_same_v<T, Vec2>) {
      value.x() = reader.real();
      value.y() = reader.real();
    } else if constexpr (std::is_same_v<T, Box>) {
      const bool is_square = value.y() == value.x();
      const double x = reader.real();
      value = Box(x, is_square ? x : reader.real());
    } else if constexpr (std::is_same_v<typename T::value_type, double>) {
      std::ranges::copy(reader.reals(value.size()), value.begin());
    } else if constexpr (std::is_same_v<typename T::value_type, std::int64_t>) {
      value = reader.integers(value.size());
      for (const std::int64_t count : value) {
        if (count < 0 || count > kMostCounted) throw StateError("counts " + std::to_string(count) + " of something");
      }
    } else {
      for (auto& element : value) take(reader, element);
    }
  }
  template <class T>
  static void take(StateReader& reader, Setting<T>& setting) {
    std::remove_cvref_t<T> stored = setting.value;
    take(reader, stored);
    if (stored != setting.value) throw StateError(std::string("saved with another ") + setting.what);
  }
  template <class T>
  static void take(StateReader& reader, IndexOrNone<T>& index) {
    index.value = reader.integer(-1, kMostCounted);
  }
  template <class... Vectors>
  static void take(StateReader& reader, Growing<Vectors...>& growing) {
    std::optional<std::size_t> length;
    std::apply([&](auto&... vector) { (take_grown(reader, vector, length), ...); }, growing.vectors);
  }
  template <class Vector>
  static void take(StateReader& reader, Length<Vector>& length) {
    const std::size_t numbers = reader.length_of(1);
    if (numbers % length.numbers != 0) throw StateError("a part of an element");
    length.vector.assign(numbers / length.numbers, length.empty);
  }
  template <class Condition, class Fields>
  static void take(StateReader& reader, Unless<Condition, Fields>& unless) {
    if (!unless.condition) take(reader, unless.fields);
  }
  template <class Vector>
  static void take_grown(StateReader& reader, Vector& vector, std::optional<std::size_t>& length) {
    if constexpr (std::is_same_v<Vector, std::vector<double>>) {
      vector = length ? reader.reals(*length) : reader.reals();
      length = vector.size();
    } else if constexpr (std::is_same_v<Vector, std::vector<std::int64_t>>) {
      vector = length ? reader.integers(*length) : reader.integers();
      length = vector.size();
    } else {
      for (auto& element : vector) take_grown(reader, element, length);
    }
  }
};

/// What is saved and restored by the list of its fields, in the order of the state:
///
///   static constexpr std::string_view kName = "Angles";             opens the state; without it, nothing does
///   static auto fields(auto& self) { return listed(Setting{"range", self.range_}, self.counts_); }
///
/// A field is a number, a Vec2, a Box, a vector or array whose length does not change, or an object with fields or with
/// save and restore. Whole numbers are counts: never negative, and at most kMostCounted. An object with fields may have
/// `bool is_sound() const`, false where what was read does not belong together.
template <class Self>
class Saved {
 public:
  void save(StateWriter& writer) const {
    if constexpr (requires { Self::kName; }) writer.tag(Self::kName);
    SavedFields::put(writer, Self::fields(static_cast<const Self&>(*this)));
  }
  /// Throws StateError, and changes nothing, if the bytes are not of such an object of the same settings.
  void restore(StateReader& reader) {
    if constexpr (requires { Self::kName; }) reader.tag(Self::kName);
    Self saved = static_cast<const Self&>(*this);
    SavedFields::take_fields(reader, saved);
    static_cast<Self&>(*this) = std::move(saved);
  }
};

}  // namespace shaken::analysis
