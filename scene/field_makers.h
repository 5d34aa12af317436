// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/check.h"
#include "scene/fields.h"

/// What the rows of the tables of keys are made with (scene/field_table.cpp, scene/observables.cpp). A row says where
/// the value lies in a plan, and from that follows how it is read and written.
namespace shaken::scene {

namespace detail {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class Object>
auto& follow(Object& object) {
  return object;
}
template <class Object, class Step, class... Rest>
auto& follow(Object& object, Step step, Rest... rest) {
  if constexpr (is_optional<std::remove_const_t<Object>>) {
    return follow(*object, step, rest...);
  } else if constexpr (std::is_member_pointer_v<Step>) {
    return follow(object.*step, rest...);
  } else {
    return follow(object[step], rest...);
  }
}

}  // namespace detail

/// The way from a plan to one of its values: members one behind the other, and indices of arrays. Optionals on the way
/// are looked into; they must be there.
template <auto... steps>
struct At {
  template <class Plan>
  auto& operator()(Plan& plan) const {
    return detail::follow(plan, steps...);
  }
};
template <auto... steps>
inline constexpr At<steps...> at{};

/// Fetches and stores the number at `access`.
template <class Access>
Field number(const std::string& path, Access access, Form form, Dimension dimension, double low, double high,
             const std::string& doc) {
  using Number = std::remove_cvref_t<decltype(access(std::declval<RunPlan&>()))>;
  return {.path = path,
          .form = form,
          .dimension = dimension,
          .low = low,
          .high = high,
          .doc = doc,
          .fetch = [access](const RunPlan& plan) { return Value(static_cast<double>(access(plan))); },
          .store = [access](RunPlan& plan,
                            const Value& value) { access(plan) = static_cast<Number>(std::get<double>(value)); }};
}

template <class Access>
Field quantity(const std::string& path, Access access, Dimension dimension, double low, double high,
               const std::string& doc) {
  return number(path, access, Form::kQuantity, dimension, low, high, doc);
}

/// The time from one sample, or frame, to the next.
template <class Access>
Field every(const std::string& path, Access access, const std::string& doc) {
  return quantity(path, access, Dimension::kTime, 1e-7, 1e5, doc);
}

template <class Access>
Field whole(const std::string& path, Access access, double low, double high, const std::string& doc) {
  return number(path, access, Form::kWhole, Dimension::kPlain, low, high, doc);
}

template <class Access>
Field on_or_off(const std::string& path, Access access, const std::string& doc) {
  return {.path = path,
          .form = Form::kSwitch,
          .doc = doc,
          .fetch = [access](const RunPlan& plan) { return Value(access(plan)); },
          .store = [access](RunPlan& plan, const Value& on) { access(plan) = std::get<bool>(on); }};
}

/// One of several values by name; `choices`: pairs of a name and its value.
template <class Access, class Choices>
Field choice(const std::string& path, Access access, const Choices& choices, const std::string& doc) {
  using Enum = std::remove_cvref_t<decltype(access(std::declval<RunPlan&>()))>;
  const std::vector<std::pair<std::string, Enum>> known(choices.begin(), choices.end());
  const auto entry = [known](auto is_it) {
    const auto found = std::find_if(known.begin(), known.end(), is_it);
    SHAKEN_CHECK(found != known.end(), "a name without value or a value without name");
    return *found;
  };
  Field field{.path = path, .form = Form::kName, .doc = doc};
  for (const auto& [name, value] : known) field.names.push_back(name);
  field.fetch = [access, entry](const RunPlan& plan) {
    return Value(entry([&](const auto& one) { return one.second == access(plan); }).first);
  };
  field.store = [access, entry](RunPlan& plan, const Value& name) {
    access(plan) = entry([&](const auto& one) { return one.first == std::get<std::string>(name); }).second;
  };
  return field;
}

template <class Enum, class Access>
Field choice(const std::string& path, Access access, std::initializer_list<std::pair<const char*, Enum>> choices,
             const std::string& doc) {
  return choice(path, access, std::vector(choices), doc);
}

/// An object that makes the optional at `access` be there; `is_on` says whether it is without being named.
template <class Access>
Field block(const std::string& path, Access access, bool is_on, const std::string& doc) {
  return {.path = path,
          .form = Form::kBlock,
          .fallback = is_on,
          .doc = doc,
          .fetch = [access](const RunPlan& plan) { return Value(access(plan).has_value()); },
          .store =
              [access](RunPlan& plan, const Value& is_there) {
                access(plan).reset();
                if (std::get<bool>(is_there)) access(plan).emplace();
              }};
}

/// A key whose value follows from others unless it is given; `note` says from which.
inline Field derived(Field field, const std::string& note) {
  field.fallback_note = note;
  return field;
}

/// A key that came later: left out of the canonical scene where it says what held before there was a choice.
inline Field later(Field field) {
  field.omit_if_default = true;
  return field;
}

}  // namespace shaken::scene
