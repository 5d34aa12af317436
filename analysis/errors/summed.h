#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>

#include "analysis/errors/saved.h"
#include "base/core/check.h"

namespace shaken::analysis {

/// An accumulator that consists of sums, or of what merges by itself, of which its fields say how they are saved and
/// merged: see Saved.
template <class Self>
class Summed : public Saved<Self> {
 public:
  /// Adds the samples of `other`, which has the same settings and lengths.
  void merge(const Self& other) { add(static_cast<Self&>(*this), other); }

 private:
  template <class T, class From>
  static void add(T& to, const From& from) {
    if constexpr (!std::is_same_v<T, Self> && requires { to.merge(from); }) {
      to.merge(from);
    } else if constexpr (requires { to.fields(to); }) {
      std::apply([&](auto&&... a) { std::apply([&](auto&&... b) { (add(a, b), ...); }, from.fields(from)); },
                 to.fields(to));
    } else if constexpr (std::is_arithmetic_v<T>) {
      to += from;
    } else {
      SHAKEN_CHECK(to.size() == from.size(), "merged with another length");
      for (std::size_t i = 0; i < to.size(); ++i) add(to[i], from[i]);
    }
  }
  template <class T, class From>
  static void add(Setting<T>& to, const Setting<From>& from) {
    SHAKEN_CHECK(to.value == from.value, std::string("merged with another ") + to.what);
  }
  template <class T, class From>
  static void add(Largest<T>& to, const Largest<From>& from) {
    to.value = std::max(to.value, from.value);
  }
};

}  // namespace shaken::analysis
