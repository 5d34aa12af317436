#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/check.h"
#include "base/keys/draft.h"
#include "base/keys/rules.h"

/// Tables of keys, each with the record of type T that they fill. A row says where its value lies in a T, and from that
/// follows how it is read and written.
namespace shaken::keys {

/// A key with the place of its value.
template <class T>
struct Key : Rule {
  /// The value in a record; asked only if the block that the key is in is on. Empty for keys that only help to write a
  /// text (bead_pitch).
  std::function<Value(const T&)> fetch = {};
  /// Puts a value into a record; empty for keys whose value other keys carry (gamma, area_fraction, ...).
  std::function<void(T&, const Value&)> store = {};
};

template <class T>
class Table : public Rules {
 public:
  /// The defaults are those of T itself, with everything switched on, where a row names no others.
  explicit Table(std::vector<Key<T>> keys) : keys_(std::move(keys)) {
    T defaults;
    std::vector<const Rule*> rules;
    for (const Key<T>& key : keys_) {
      if (key.form == Form::kBlock) key.store(defaults, true);
    }
    for (Key<T>& key : keys_) {
      const bool is_open = std::holds_alternative<std::monostate>(key.fallback) && key.fallback_note.empty();
      if (is_open && key.fetch) key.fallback = key.fetch(defaults);
      rules.push_back(&key);
    }
    set(std::move(rules));
  }

  auto begin() const { return keys_.begin(); }
  auto end() const { return keys_.end(); }
  std::size_t size() const { return keys_.size(); }
  const Key<T>& operator[](std::size_t index) const { return keys_[index]; }

  /// The key at `path`, which must exist.
  const Key<T>& at(std::string_view path) const {
    const int found = index(path);
    SHAKEN_CHECK(found >= 0, std::string(path));
    return keys_[static_cast<std::size_t>(found)];
  }
  /// The block around a key; null if there is none.
  const Key<T>* block_of(const Key<T>& key) const {
    const int block = Rules::block_of(static_cast<std::size_t>(&key - keys_.data()));
    return block < 0 ? nullptr : &keys_[static_cast<std::size_t>(block)];
  }
  /// The value of a key in a record; nothing if the block that it is in is off.
  Value value(const T& record, const Key<T>& key) const {
    const Key<T>* block = block_of(key);
    const bool is_off = block != nullptr && !std::get<bool>(block->fetch(record));
    return key.fetch && !is_off ? key.fetch(record) : Value();
  }

  /// Puts every value that was given where it belongs, in the order of the table; a block that nothing was said of is
  /// on or off as it usually is. False if a problem had been reported with a value, which is then left as it is.
  bool store(const Draft& draft, T& record) const {
    bool all_ok = true;
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      const Given* given = draft.find(i);
      all_ok = all_ok && (!given || given->ok);
      const bool is_given = given && given->ok && !std::holds_alternative<std::monostate>(given->value);
      const int block = Rules::block_of(i);
      if (!keys_[i].store || !(is_given || keys_[i].form == Form::kBlock)) continue;
      if (block < 0 || draft.is_on(static_cast<std::size_t>(block))) {
        keys_[i].store(record, is_given ? given->value : keys_[i].fallback);
      }
    }
    return all_ok;
  }

  /// `record` with what `text` says, a JSON object of these keys; or all that is wrong with it.
  Loaded<T> read(std::string_view text, const std::string& file, T record = {}) const {
    std::vector<Problem> problems;
    const std::optional<Node> document = parse_document(text, file, problems);
    if (!document) return problems;
    Draft draft(*this, document->place);
    draft.read(*document, problems);
    store(draft, record);
    if (!problems.empty()) return tidied(std::move(problems));
    return record;
  }

 private:
  std::vector<Key<T>> keys_;
};

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

/// A number, a text, a switch, two numbers or a list as a value.
template <class Plain>
Value to_value(const Plain& plain) {
  if constexpr (is_optional<Plain>) {
    return plain ? to_value(*plain) : Value();
  } else if constexpr (requires { typename Plain::period; }) {
    return std::chrono::duration<double>(plain).count();
  } else if constexpr (requires { plain.x(); }) {
    return std::array<double, 2>{plain.x(), plain.y()};
  } else if constexpr (std::is_arithmetic_v<Plain> && !std::is_same_v<Plain, bool>) {
    return static_cast<double>(plain);
  } else {
    return plain;
  }
}

/// And back.
template <class Plain>
void from_value(const Value& value, Plain& plain) {
  if constexpr (is_optional<Plain>) {
    from_value(value, plain.emplace());
  } else if constexpr (requires { typename Plain::period; }) {
    plain = std::chrono::duration_cast<Plain>(std::chrono::duration<double>(std::get<double>(value)));
  } else if constexpr (requires { plain.x(); }) {
    const auto& [x, y] = std::get<std::array<double, 2>>(value);
    plain = {x, y};
  } else if constexpr (std::is_arithmetic_v<Plain> && !std::is_same_v<Plain, bool>) {
    plain = static_cast<Plain>(std::get<double>(value));
  } else {
    plain = std::get<Plain>(value);
  }
}

}  // namespace detail

/// The way from a record to one of its values: members one behind the other, and indices of arrays. Optionals on the
/// way are looked into; they must be there.
template <auto... steps>
struct At {
  template <class T>
  auto& operator()(T& record) const {
    return detail::follow(record, steps...);
  }
};
template <auto... steps>
inline constexpr At<steps...> at{};

/// A row that has yet to become the key of a table: `fetch(record)` and `store(record, value)` work on every record
/// that has its members.
template <class Fetch, class Store>
struct Row : Rule {
  Fetch fetch;
  Store store;

  template <class T>
  operator Key<T>() const {  // NOLINT(google-explicit-constructor): rows are written as keys
    return {*this, fetch, store};
  }
};

/// The value at `access` as it stands there.
template <class Access>
auto plain(Rule rule, Access access) {
  const auto fetch = [access](const auto& record) { return detail::to_value(access(record)); };
  const auto store = [access](auto& record, const Value& value) { detail::from_value(value, access(record)); };
  return Row<decltype(fetch), decltype(store)>{std::move(rule), fetch, store};
}

template <class Access>
auto quantity(const std::string& path, Access access, Dimension dimension, double low, double high,
              const std::string& doc) {
  return plain({.path = path, .dimension = dimension, .low = low, .high = high, .doc = doc}, access);
}

template <class Access>
auto whole(const std::string& path, Access access, double low, double high, const std::string& doc) {
  return plain({.path = path, .form = Form::kWhole, .low = low, .high = high, .doc = doc}, access);
}

template <class Access>
auto on_or_off(const std::string& path, Access access, const std::string& doc) {
  return plain({.path = path, .form = Form::kSwitch, .doc = doc}, access);
}

/// Whatever text, or a list of such.
template <class Access>
auto text(const std::string& path, Access access, const std::string& doc) {
  return plain({.path = path, .form = Form::kText, .doc = doc}, access);
}
template <class Access>
auto texts(const std::string& path, Access access, const std::string& doc) {
  return plain({.path = path, .form = Form::kTexts, .doc = doc}, access);
}

/// One of several values by name; `choices`: pairs of a name and its value.
template <class Access, class Choices>
auto choice(const std::string& path, Access access, const Choices& choices, const std::string& doc) {
  using Enum = std::remove_cvref_t<decltype(choices.begin()->second)>;
  const std::vector<std::pair<std::string, Enum>> known(choices.begin(), choices.end());
  const auto entry = [known](auto is_it) {
    const auto found = std::find_if(known.begin(), known.end(), is_it);
    SHAKEN_CHECK(found != known.end(), "a name without value or a value without name");
    return *found;
  };
  const auto fetch = [access, entry](const auto& record) {
    return Value(entry([&](const auto& one) { return one.second == access(record); }).first);
  };
  const auto store = [access, entry](auto& record, const Value& name) {
    access(record) = entry([&](const auto& one) { return one.first == std::get<std::string>(name); }).second;
  };
  Row<decltype(fetch), decltype(store)> row{{.path = path, .form = Form::kName, .doc = doc}, fetch, store};
  for (const auto& [name, value] : known) row.names.push_back(name);
  return row;
}

template <class Enum, class Access>
auto choice(const std::string& path, Access access, std::initializer_list<std::pair<const char*, Enum>> choices,
            const std::string& doc) {
  return choice(path, access, std::vector(choices), doc);
}

/// Width and height, each at its place.
template <class Width, class Height>
auto size(const std::string& path, Width width, Height height, double low, double high, const std::string& doc) {
  const auto fetch = [=](const auto& record) {
    return Value(std::array{static_cast<double>(width(record)), static_cast<double>(height(record))});
  };
  const auto store = [=](auto& record, const Value& value) {
    const auto& two = std::get<std::array<double, 2>>(value);
    width(record) = static_cast<int>(two[0]);
    height(record) = static_cast<int>(two[1]);
  };
  return Row<decltype(fetch), decltype(store)>{
      {.path = path, .form = Form::kSize, .low = low, .high = high, .value_name = "WxH", .doc = doc}, fetch, store};
}

/// An object that makes the optional at `access` be there; `is_on` says whether it is without being named.
template <class Access>
auto block(const std::string& path, Access access, bool is_on, const std::string& doc) {
  const auto fetch = [access](const auto& record) { return Value(access(record).has_value()); };
  const auto store = [access](auto& record, const Value& is_there) {
    access(record).reset();
    if (std::get<bool>(is_there)) access(record).emplace();
  };
  return Row<decltype(fetch), decltype(store)>{
      {.path = path, .form = Form::kBlock, .fallback = is_on, .doc = doc}, fetch, store};
}

/// A key whose value follows from others unless it is given; `note` says from which.
auto derived(auto row, const std::string& note) {
  row.fallback_note = note;
  return row;
}

/// A key as figures call it: Rule::title, symbol, and unit of a plain number.
auto called(const std::string& title, const std::string& symbol, const std::string& unit, auto row) {
  row.title = title;
  row.symbol = symbol;
  row.unit = unit;
  return row;
}
auto called(const std::string& title, const std::string& symbol, auto row) {
  return called(title, symbol, "", std::move(row));
}

/// A key that came later: left out of the canonical text where it says what held before there was a choice.
auto later(auto row) {
  row.omit_if_default = true;
  return row;
}

}  // namespace shaken::keys
