// SPDX-License-Identifier: MIT
#include "bench/options.h"

#include <fmt/format.h>

#include "base/failure.h"
#include "scene/decimal.h"

namespace shaken::bench {
namespace {

std::vector<std::string> split(const std::string& words) {
  std::vector<std::string> parts(1);
  for (const char c : words) {
    if (c == ',') {
      parts.emplace_back();
    } else if (c != ' ') {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

double OptionReader::number(const std::string& option, const std::string& word, double low, double high) {
  return read(option, word, low, high, false).value_or(low);
}

int OptionReader::whole(const std::string& option, const std::string& word, int low, int high) {
  return static_cast<int>(read(option, word, low, high, true).value_or(low));
}

std::vector<double> OptionReader::numbers(const std::string& option, const std::string& words, double low,
                                          double high) {
  std::vector<double> values;
  for (const std::string& word : split(words)) {
    if (const auto value = read(option, word, low, high, false)) values.push_back(*value);
  }
  return values;
}

std::vector<int> OptionReader::wholes(const std::string& option, const std::string& words, int low, int high) {
  std::vector<int> values;
  for (const std::string& word : split(words)) {
    if (const auto value = read(option, word, low, high, true)) values.push_back(static_cast<int>(*value));
  }
  return values;
}

std::optional<double> OptionReader::read(const std::string& option, const std::string& word, double low, double high,
                                         bool whole) {
  const auto decimal = scene::parse_decimal(word);
  if (!decimal) {
    complain(fmt::format("{}: '{}' is not a number", option, word));
  } else if (decimal->value() < low || decimal->value() > high) {
    complain(fmt::format("{}: {} is outside [{:.10g}, {:.10g}]", option, word, low, high));
  } else if (whole && !decimal->is_whole()) {
    complain(fmt::format("{}: {} is not a whole number", option, word));
  } else {
    return decimal->value();
  }
  return std::nullopt;
}

void OptionReader::finish() const {
  if (problems_.empty()) return;
  std::string all = problems_.size() == 1 ? "" : fmt::format("{} problems", problems_.size());
  for (const std::string& problem : problems_) all += (all.empty() ? "" : "\n  ") + problem;
  throw Failure(ExitCode::kBadInput, all);
}

}  // namespace shaken::bench
