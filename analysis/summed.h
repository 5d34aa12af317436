// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/box.h"
#include "base/core/check.h"
#include "base/core/state_io.h"

namespace shaken::analysis {

/// A field that is no sum but a setting: the same in all that are merged and in a state that is restored.
template <class Member>
struct Setting {
  const char* what;  ///< "range": for the message where it differs
  Member member;
};
/// A field of which the larger value holds when two are merged: what others have taken before.
template <class Member>
struct Largest {
  Member member;
};

template <class Member>
Setting(const char*, Member) -> Setting<Member>;
template <class Member>
Largest(Member) -> Largest<Member>;

/// No run counts farther; what is made of counts (sums over stretches, means) then neither overflows nor loses digits.
inline constexpr std::int64_t kMostCounted = std::int64_t{1} << 53;

/// An accumulator that consists of sums: merging adds them, and its saved state is the sums one behind the other. A
/// class says which fields it has once, in the order of the state,
///
///   static constexpr std::string_view kName = "Angles";             opens the state; empty: nothing does
///   static constexpr auto fields() { return std::tuple(Setting{"range", &Angles::range_}, &Angles::counts_); }
///
/// and gets merge, save and restore by deriving from Summed<Angles>. A field is a number, a vector or array of numbers
/// whose length does not change, a Box, or a struct with fields() of its own. Whole numbers are counts: never negative,
/// and at most kMostCounted.
template <class Self>
class Summed {
 public:
  /// Adds the samples of `other`, which has the same settings and lengths.
  void merge(const Self& other) {
    Self& self = static_cast<Self&>(*this);
    for_fields(Self::fields(), [&](const auto& field) { merge_field(self, other, field); });
  }
  void save(StateWriter& writer) const {
    if (!Self::kName.empty()) writer.tag(Self::kName);
    const Self& self = static_cast<const Self&>(*this);
    for_fields(Self::fields(), [&](const auto& field) { put(writer, self.*member_of(field)); });
  }
  /// Throws StateError, and changes nothing, if the bytes are not of such an accumulator of the same settings.
  void restore(StateReader& reader) {
    if (!Self::kName.empty()) reader.tag(Self::kName);
    Self saved = static_cast<const Self&>(*this);
    for_fields(Self::fields(), [&](const auto& field) { take_field(reader, saved, field); });
    static_cast<Self&>(*this) = std::move(saved);
  }

 private:
  template <class Fields, class Visit>
  static void for_fields(const Fields& fields, Visit visit) {
    std::apply([&](const auto&... field) { (visit(field), ...); }, fields);
  }

  template <class Member>
  static Member member_of(Member member) {
    return member;
  }
  template <class Member>
  static Member member_of(const Setting<Member>& setting) {
    return setting.member;
  }
  template <class Member>
  static Member member_of(const Largest<Member>& largest) {
    return largest.member;
  }

  template <class T>
  static constexpr bool is_number = std::is_arithmetic_v<T>;

  template <class Object, class Member>
  static void merge_field(Object& to, const Object& from, Member member) {
    add(to.*member, from.*member);
  }
  template <class Object, class Member>
  static void merge_field(Object& to, const Object& from, const Setting<Member>& setting) {
    SHAKEN_CHECK(to.*setting.member == from.*setting.member, std::string("merged with another ") + setting.what);
  }
  template <class Object, class Member>
  static void merge_field(Object& to, const Object& from, const Largest<Member>& largest) {
    to.*largest.member = std::max(to.*largest.member, from.*largest.member);
  }

  template <class T>
  static void add(T& to, const T& from) {
    if constexpr (is_number<T>) {
      to += from;
    } else if constexpr (requires { T::fields(); }) {
      for_fields(T::fields(), [&](const auto& field) { merge_field(to, from, field); });
    } else {
      SHAKEN_CHECK(to.size() == from.size(), "merged with another length");
      for (std::size_t i = 0; i < to.size(); ++i) add(to[i], from[i]);
    }
  }

  template <class T>
  static void put(StateWriter& writer, const T& value) {
    if constexpr (requires { T::fields(); }) {
      for_fields(T::fields(), [&](const auto& field) { put(writer, value.*member_of(field)); });
    } else if constexpr (std::is_same_v<T, Box>) {  // of a square one number
      writer.put(value.x());
      if (value.y() != value.x()) writer.put(value.y());
    } else {
      writer.put(value);
    }
  }

  template <class Object, class Member>
  static void take_field(StateReader& reader, Object& saved, Member member) {
    take(reader, saved.*member);
  }
  template <class Object, class Member>
  static void take_field(StateReader& reader, Object& saved, const Largest<Member>& largest) {
    take(reader, saved.*largest.member);
  }
  template <class Object, class Member>
  static void take_field(StateReader& reader, Object& saved, const Setting<Member>& setting) {
    auto stored = saved.*setting.member;
    take(reader, stored);
    if (stored == saved.*setting.member) return;
    throw StateError(std::string(Self::kName) + " of another " + setting.what);
  }

  template <class T>
  static void take(StateReader& reader, T& value) {
    if constexpr (std::is_same_v<T, double>) {
      value = reader.real();
    } else if constexpr (std::is_same_v<T, Box>) {
      const bool is_square = value.y() == value.x();
      const double x = reader.real();
      value = Box(x, is_square ? x : reader.real());
    } else if constexpr (is_number<T>) {
      value = static_cast<T>(reader.integer(0, std::min<std::int64_t>(kMostCounted, std::numeric_limits<T>::max())));
    } else if constexpr (requires { T::fields(); }) {
      for_fields(T::fields(), [&](const auto& field) { take_field(reader, value, field); });
    } else if constexpr (std::is_same_v<typename T::value_type, double>) {
      const std::vector<double> values = reader.reals(value.size());
      std::copy(values.begin(), values.end(), value.begin());
    } else {
      value = reader.integers(value.size());
      for (const std::int64_t count : value) {
        if (count < 0 || count > kMostCounted) throw StateError("counts " + std::to_string(count) + " of something");
      }
    }
  }
};

}  // namespace shaken::analysis
