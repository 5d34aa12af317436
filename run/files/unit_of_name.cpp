#include "run/files/unit_of_name.h"

#include <algorithm>
#include <array>
#include <string>

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

/// Where the unit of a name begins, with the underscore in front: 5 of "total_mm2".
std::size_t unit_begin(std::string_view name) {
  std::size_t begin = name.size();
  const auto word_before = [&] {
    const std::size_t at = name.substr(0, begin).find_last_of("_/");
    return at == std::string_view::npos || name[at] == '/' ? std::string_view() : name.substr(at + 1, begin - at - 1);
  };
  const auto pass_units = [&] {
    while (factor_of(word_before()).power > 0) begin -= word_before().size() + 1;
  };
  pass_units();
  if (begin < name.size() && word_before() == "per") {
    begin -= 4;
    pass_units();  // "s_per_mm"
  }
  return begin;
}

}  // namespace

std::span<const std::string_view> unit_symbols() { return kSymbols; }

std::string with_sem(std::string_view name) { return std::string(name).insert(unit_begin(name), "_sem"); }

std::string unit_of_name(std::string_view name) {
  std::string_view words = name.substr(unit_begin(name));
  const bool is_inverse = words.starts_with("_per");
  std::string unit;
  for (bool is_first = true; !words.empty(); is_first = false) {
    words.remove_prefix(1);
    const auto [symbol, power] = factor_of(words.substr(0, words.find('_')));
    words.remove_prefix(std::min(words.size(), words.find('_')));
    if (power == 0) continue;  // "per"
    const int signed_power = is_first && !is_inverse ? power : -power;
    if (!unit.empty()) unit += ' ';
    unit += symbol;
    if (signed_power != 1) unit += std::to_string(signed_power);
  }
  return unit.empty() ? "1" : unit;
}

}  // namespace shaken::run
