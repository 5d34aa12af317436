// SPDX-License-Identifier: MIT
#include "run/files/unit_of_name.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace shaken::run {
namespace {

constexpr std::array<std::string_view, 7> kSymbols{"mm", "s", "rad", "deg", "mg", "pJ", "Hz"};

/// A symbol and its power: "mm2".
struct Factor {
  std::string_view symbol;
  int power = 0;  ///< 0: not a unit
};

Factor factor_of(std::string_view word) {
  const std::size_t digits = word.find_last_not_of("0123456789") + 1;
  const std::string_view symbol = word.substr(0, digits);
  if (std::find(kSymbols.begin(), kSymbols.end(), symbol) == kSymbols.end()) return {};
  return {symbol, digits == word.size() ? 1 : std::stoi(std::string(word.substr(digits)))};
}

}  // namespace

std::span<const std::string_view> unit_symbols() { return kSymbols; }

std::string unit_of_name(std::string_view name) {
  std::vector<std::string_view> words;
  for (std::string_view rest = name.substr(name.find_last_of('/') + 1);; rest.remove_prefix(rest.find('_') + 1)) {
    words.push_back(rest.substr(0, rest.find('_')));
    if (rest.find('_') == std::string_view::npos) break;
  }
  std::size_t first = words.size();
  while (first > 0 && factor_of(words[first - 1]).power > 0) --first;
  const bool is_inverse = first > 0 && words[first - 1] == "per";
  std::string unit;
  for (std::size_t w = first; w < words.size(); ++w) {
    const auto [symbol, power] = factor_of(words[w]);
    const int signed_power = w == first && !is_inverse ? power : -power;
    if (!unit.empty()) unit += ' ';
    unit += symbol;
    if (signed_power != 1) unit += std::to_string(signed_power);
  }
  return unit.empty() ? "1" : unit;
}

}  // namespace shaken::run
