#pragma once

#include <array>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "run/measure/estimates.h"
#include "run/measure/measurement_kinds.h"

namespace shaken::run {

/// An array of observables.h5, or a number of summary.json, with what it is of Found: of a series, or of what samples
/// come down to. Value: EstimateCurve, whose errors may be missing, or Scalar.
template <class Found, class Value>
struct Row : Output {
  Value (*of)(const Found&);
};

namespace detail {

inline analysis::EstimateCurve value_of(const std::vector<double>& values) { return {values, {}}; }
inline analysis::EstimateCurve value_of(const analysis::EstimateCurve& curve) { return curve; }
inline analysis::EstimateCurve value_of(const std::vector<Estimate>& points) {
  analysis::EstimateCurve curve;
  for (const Estimate& point : points) curve.push_back(point);
  return curve;
}
inline Scalar value_of(double value) { return {{value}}; }
inline Scalar value_of(const Estimate& estimate) { return {estimate}; }
inline Scalar value_of(const Scalar& scalar) { return scalar; }

template <class Of>
struct FoundOf;
template <class Found, class Member>
struct FoundOf<Member Found::*> {
  using Type = Found;
};
template <class Found, class Value>
struct FoundOf<Value (*)(const Found&)> {
  using Type = Found;
};

}  // namespace detail

/// `output` as kOf gives it: a member, a member function, a function or a lambda of Found. It has errors where kOf
/// gives them, or where it says so: then they are found by the jackknife.
template <auto kOf>
constexpr auto from(Output output) {
  if constexpr (std::is_class_v<decltype(kOf)>) {
    return from<+kOf>(output);
  } else {
    using Found = typename detail::FoundOf<std::remove_const_t<decltype(kOf)>>::Type;
    using Given = std::remove_cvref_t<std::invoke_result_t<decltype(kOf), const Found&>>;
    using Value = decltype(detail::value_of(std::declval<Given>()));
    constexpr bool kGivesErrors =
        std::is_same_v<Given, analysis::EstimateCurve> || std::is_same_v<Given, std::vector<Estimate>>;
    output.has_error = output.has_error || kGivesErrors;
    return Row<Found, Value>{{output}, [](const Found& found) { return detail::value_of(std::invoke(kOf, found)); }};
  }
}

/// The rows as MeasurementKind lists them.
std::vector<Output> outputs_of(const auto&... rows) {
  std::vector<Output> all;
  (all.insert(all.end(), std::begin(rows), std::end(rows)), ...);
  return all;
}

inline void put(Reduction& result, const std::string& name, const Output&, const Scalar& value) {
  result.scalars[name] = value;
}
inline void put(Reduction& result, const std::string& path, const Output& output,
                const analysis::EstimateCurve& curve) {
  if (output.has_error) {
    put(result, path, curve);
  } else {
    result.arrays[path] = curve.value;
  }
}

/// All rows of what was found, with errors where it has them. The names of arrays begin with `prefix`, "/flow/"; those
/// of numbers, as a rule, with nothing.
template <class Found, class Value, std::size_t n>
void put(Reduction& result, const std::string& prefix, const std::array<Row<Found, Value>, n>& rows,
         const Found& found) {
  for (const auto& row : rows) put(result, prefix + std::string(row.name), row, row.of(found));
}

/// All rows of what `reduce`(samples) finds in the steady state, with errors by the jackknife over all stretches of
/// time that there are. The length of an array does not depend on the samples.
template <class Found, class Value, std::size_t n, class Accumulator>
void put(
    Reduction& result, const std::string& prefix, const std::array<Row<Found, Value>, n>& rows,
    const analysis::Blocked<Accumulator>& samples,
    const std::type_identity_t<std::function<Found(const Accumulator&)>>& reduce = [](const Accumulator& part) {
      return part.reduce();
    }) {
  const Found all = reduce(samples.after(result.t_steady));
  if constexpr (std::is_same_v<Value, Scalar>) {
    const auto numbers = block_estimates(samples, result.t_steady, [&](const Accumulator& part) {
      const Found found = reduce(part);
      std::vector<double> values;
      values.reserve(n);
      for (const auto& row : rows) values.push_back(row.of(found).value);
      return values;
    });
    for (std::size_t k = 0; k < n; ++k) put(result, prefix + std::string(rows[k].name), rows[k], numbers[k]);
  } else {
    const auto errors = block_errors(samples, result.t_steady, [&](const Accumulator& part) {
      const Found found = reduce(part);
      std::vector<std::vector<double>> curves;
      curves.reserve(n);
      for (const auto& row : rows) curves.push_back(row.has_error ? row.of(found).value : std::vector<double>());
      return curves;
    });
    for (std::size_t k = 0; k < n; ++k)
      put(result, prefix + std::string(rows[k].name), rows[k], {rows[k].of(all).value, errors[k]});
  }
}

}  // namespace shaken::run
