// SPDX-License-Identifier: MIT
#include "client/paper/questions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "client/paper/panels.h"

namespace shaken::client {
namespace {

/// Errors by which neighbours of a trend may go the other way: with ten of them two errors would be met by chance.
constexpr double kStepBack = 3;

using Word = Answer::Word;

Answer compared(const Quantity& a, const Quantity& b, double sigmas) {
  for (const Quantity& quantity : {a, b}) {
    if (std::string why = doubt(quantity); !why.empty()) return unknown(std::move(why));
  }
  const double margin = sigmas * std::hypot(a.sem, b.sem);
  if (a.value - b.value > margin) return yes();
  return b.value - a.value > margin ? no() : unknown("the errors are too large");
}

std::ptrdiff_t count(const std::vector<Answer>& answers, Word word) {
  return std::count_if(answers.begin(), answers.end(), [&](const Answer& answer) { return answer.word == word; });
}

/// Why the unknown ones are, each reason once.
std::string reasons(const std::vector<Answer>& answers) {
  std::vector<std::string> seen;
  std::string words;
  for (const Answer& answer : answers) {
    if (answer.word != Word::kUnknown || std::find(seen.begin(), seen.end(), answer.why) != seen.end()) continue;
    seen.push_back(answer.why);
    words = listed(std::move(words), answer.why);
  }
  return words;
}

}  // namespace

Answer yes() { return {Word::kYes}; }
Answer no() { return {Word::kNo}; }
Answer unknown(std::string why) { return {Word::kUnknown, std::move(why)}; }

std::string doubt(const Quantity& quantity) {
  if (!quantity.is_known()) return "not measured everywhere";
  if (quantity.steadiness == Steadiness::kRelaxing) return "a run still relaxes";
  if (!std::isfinite(quantity.sem)) return "too few independent samples for an error";
  if (quantity.steadiness == Steadiness::kUnknown) return "not known whether a run is steady";
  return "";
}

Answer larger(const Quantity& a, const Quantity& b) { return compared(a, b, kSigmas); }
Answer above(const Quantity& quantity, double level) { return larger(quantity, exactly(level)); }
Answer below(const Quantity& quantity, double level) { return larger(exactly(level), quantity); }

Answer close_to(const Quantity& quantity, double target, double tolerance) {
  if (std::string why = doubt(quantity); !why.empty()) return unknown(std::move(why));
  const double away = std::abs(quantity.value - target);
  if (away + kSigmas * quantity.sem <= tolerance) return yes();
  return away - kSigmas * quantity.sem > tolerance ? no() : unknown("the errors are too large");
}

Answer trend(const std::vector<Point>& points, bool rising) {
  std::vector<Quantity> deciding;
  std::string why = "fewer than two points";
  for (const Point& point : points) {
    std::string doubtful = doubt(point.quantity);
    if (doubtful.empty()) {
      deciding.push_back(point.quantity);
    } else {
      why = std::move(doubtful);
    }
  }
  if (deciding.size() < 2) return unknown(why);
  if (!rising) std::reverse(deciding.begin(), deciding.end());
  for (std::size_t k = 1; k < deciding.size(); ++k) {
    if (compared(deciding[k - 1], deciding[k], kStepBack) == yes()) return no();
  }
  return larger(deciding.back(), deciding.front());
}

Finding conclude(const std::vector<Answer>& answers, std::string found) {
  if (answers.empty()) return {};
  const bool any_yes = count(answers, Word::kYes) > 0, any_no = count(answers, Word::kNo) > 0;
  if (any_yes && any_no) return {Verdict::kPartly, std::move(found)};
  if (count(answers, Word::kUnknown) > 0) return {Verdict::kUnresolved, std::move(found), reasons(answers)};
  return {any_yes ? Verdict::kAgrees : Verdict::kDisagrees, std::move(found)};
}

Finding conclude_everywhere(const std::vector<Answer>& answers, std::string found) {
  if (count(answers, Word::kNo) > 0) return {Verdict::kDisagrees, std::move(found)};
  return conclude(answers, std::move(found));
}

std::vector<Answer> telling(const std::vector<Answer>& answers) {
  std::vector<Answer> able;
  std::copy_if(answers.begin(), answers.end(), std::back_inserter(able),
               [](const Answer& answer) { return answer.word != Word::kUnknown; });
  return able.empty() ? answers : able;
}

std::string text(const Quantity& quantity, int digits) {
  if (!quantity.is_known()) return "-";
  std::string words;
  if (std::isfinite(quantity.sem)) {
    if (quantity.sem > 0) digits = std::clamp(static_cast<int>(std::ceil(-std::log10(quantity.sem))), digits, 6);
    words = fmt::format("{:.{}f} ± {:.{}f}", quantity.value, digits, quantity.sem, digits);
  } else {
    words = fmt::format("{:.{}f} ± ?", quantity.value, digits);
  }
  return quantity.steadiness == Steadiness::kRelaxing ? words + " (still relaxing)" : words;
}

std::string text(const std::vector<Point>& points, const std::string& key, int digits) {
  std::string words;
  for (const auto& [at, quantity] : points) {
    words = listed(std::move(words), fmt::format("{} at {}", text(quantity, digits), value_label(key, at)));
  }
  return words;
}

std::string listed(std::string words, const std::string& more) {
  if (!words.empty() && !more.empty()) words += "; ";
  return words + more;
}

}  // namespace shaken::client
